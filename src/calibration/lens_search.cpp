#include "lens_search.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "distortion_centre.h"
#include "radial_pose.h"
#include "radial_profile.h"
#include "spread.h"
#include "tartan_calib/solver/parallel.h"

namespace tartan_calib::calibration {
namespace {

constexpr std::size_t kMaxCentreViews = 12;
constexpr double kMaxCentreOffset = 0.2;  ///< of the distortion centre from the image centre, in half widths
constexpr std::size_t kMaxGuesses = 6;    ///< per centre

/// Image and board in the units of the search.
struct Units {
  Eigen::Vector2d image_centre_px;
  double image_px;  ///< half the image's width
  Eigen::Vector2d board_centre_m;
  double board_m;
};

Units unitsOf(const ImageInfo& image, const std::vector<Eigen::Vector3d>& target_points) {
  Units units{0.5 * Eigen::Vector2d(image.width - 1, image.height - 1), 0.5 * image.width, Eigen::Vector2d::Zero(), 0.0};
  for (const Eigen::Vector3d& p : target_points) {
    units.board_centre_m += p.head<2>() / static_cast<double>(target_points.size());
  }
  for (const Eigen::Vector3d& p : target_points) {
    units.board_m = std::max(units.board_m, (p.head<2>() - units.board_centre_m).norm());
  }
  return units;
}

NormalView normalView(const Units& units, const std::vector<Eigen::Vector3d>& target_points,
                      const observation::CameraView& view) {
  NormalView result;
  for (const observation::Corner& corner : view.corners) {
    const Eigen::Vector2d p_m = target_points.at(static_cast<std::size_t>(corner.corner_id)).head<2>();
    result.push_back({(corner.px - units.image_centre_px) / units.image_px, (p_m - units.board_centre_m) / units.board_m});
  }
  return result;
}

std::vector<ProfileView> profileViews(const std::vector<NormalView>& views, const Eigen::Vector2d& centre) {
  std::vector<ProfileView> result;
  for (const NormalView& view : views) {
    if (const std::optional<RadialHomography> H = searchRadialHomography(view, centre)) {
      if (const std::optional<ProfileView> profile_view = profileView(view, centre, *H)) {
        result.push_back(*profile_view);
      }
    }
  }
  return result;
}

LensGuess lensGuess(const RadialProfile& profile, const Eigen::Vector2d& centre, double max_radius, const Units& units) {
  constexpr int kRadii = 40;
  constexpr int kAzimuths = 8;
  LensGuess guess;
  guess.centre_px = units.image_centre_px + units.image_px * centre;
  guess.focal_px = units.image_px * profile.coefficients(0);
  guess.max_angle_rad = profile.angle(max_radius);
  for (int i = 1; i <= kRadii; ++i) {
    const double r = max_radius * i / kRadii;
    for (int k = 0; k < kAzimuths; ++k) {
      const double azimuth_rad = 2.0 * M_PI * k / kAzimuths;
      const Eigen::Vector2d x(r * std::cos(azimuth_rad), r * std::sin(azimuth_rad));
      const Eigen::Vector3d ray(x.x(), x.y(), profile.psi(r));
      guess.samples.push_back({ray.normalized(), guess.centre_px + units.image_px * x});
    }
  }
  return guess;
}

}  // namespace

std::vector<LensGuess> searchLens(const ImageInfo& image, const std::vector<Eigen::Vector3d>& target_points,
                                  const std::vector<observation::CameraView>& views) {
  const Units units = unitsOf(image, target_points);
  std::vector<NormalView> normal_views;
  for (const observation::CameraView& view : views) {
    normal_views.push_back(normalView(units, target_points, view));
  }
  std::optional<double> focal_hint;
  if (image.focal_hint_px) {
    focal_hint = *image.focal_hint_px / units.image_px;
  }
  const std::vector<Eigen::Vector2d> centres = findDistortionCentres(
      spread(normal_views, kMaxCentreViews), Eigen::Vector2d::Zero(), kMaxCentreOffset, image.num_threads);
  std::vector<std::vector<std::pair<double, LensGuess>>> guesses_by_centre(centres.size());
  solver::forEachItem(static_cast<int>(centres.size()), image.num_threads, [&](std::size_t i) {
    const std::vector<ProfileView> profile_views = profileViews(normal_views, centres[i]);
    for (const ScoredProfile& scored : searchProfiles(profile_views, focal_hint, kMaxGuesses)) {
      guesses_by_centre[i].emplace_back(scored.score,
                                        lensGuess(scored.profile, centres[i], maxRadius(profile_views), units));
    }
  });
  std::vector<std::pair<double, LensGuess>> guesses;
  for (const auto& of_centre : guesses_by_centre) {
    guesses.insert(guesses.end(), of_centre.begin(), of_centre.end());
  }
  std::stable_sort(guesses.begin(), guesses.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<LensGuess> result;
  for (const auto& [score, guess] : guesses) {
    result.push_back(guess);
  }
  return result;
}

}  // namespace tartan_calib::calibration
