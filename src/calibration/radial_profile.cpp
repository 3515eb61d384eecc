#include "radial_profile.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "robust.h"
#include "spread.h"
#include "tartan_calib/median.h"

namespace tartan_calib::calibration {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
/// Radial error at which a view counts as not explained, as a share of half the image's width.
constexpr double kMaxError = 0.1;
/// Board points closer to the axis than this (in board sizes) say nothing about the profile.
constexpr double kMinDistance = 1e-3;

/// Corners of a view that take part: all views together have more than enough.
constexpr std::size_t kMaxSamples = 64;

using Samples = std::vector<RadialSample>;

/// A view under the better of its two rotations.
struct Explanation {
  const Samples* samples = nullptr;
  double t_z = 0.0;  ///< the board's distance along the axis
  double error = kInfinity;
};

/// Between the sample's radius and the one where the profile sees its board point, to first order in the angle.
double radialErrorOf(const RadialProfile& profile, const RadialSample& s, double depth) {
  const double psi = profile.psi(s.r);
  const double dot = s.r * s.distance + psi * depth;
  if (dot <= 0.0) {
    return kInfinity;
  }
  const double cross = s.distance * psi - s.r * depth;
  const double image_norm2 = s.r * s.r + psi * psi;
  const double sine = cross / std::sqrt(image_norm2 * (s.distance * s.distance + depth * depth));
  return std::abs(sine) * image_norm2 / profile.growth(s.r);
}

/// The distance along the axis with the smallest sum of absolute radial errors, and their median.
Explanation explain(const RadialProfile& profile, const Samples& samples) {
  std::vector<std::pair<double, double>> distances;
  for (const RadialSample& s : samples) {
    // d(radius) / d(t_z) to first order.
    const double weight = s.r * s.r / (s.distance * profile.growth(s.r));
    distances.emplace_back(s.distance * profile.psi(s.r) / s.r - s.depth, weight);
  }
  Explanation result;
  result.samples = &samples;
  result.t_z = weightedMedian(distances);
  std::vector<double> errors;
  for (const RadialSample& s : samples) {
    errors.push_back(radialErrorOf(profile, s, s.depth + result.t_z));
  }
  result.error = upperMedian(errors);
  return result;
}

std::vector<Explanation> explainAll(const RadialProfile& profile, const std::vector<ProfileView>& views) {
  std::vector<Explanation> result;
  for (const ProfileView& view : views) {
    const Explanation a = explain(profile, view.samples[0]);
    const Explanation b = explain(profile, view.samples[1]);
    result.push_back(a.error <= b.error ? a : b);
  }
  return result;
}

double meanCapped(const std::vector<Explanation>& explanations) {
  double sum = 0.0;
  for (const Explanation& e : explanations) {
    sum += std::min(e.error, kMaxError);
  }
  return sum / static_cast<double>(explanations.size());
}

/// distance * psi(r) - r * t_z = r * depth is linear in psi's coefficients and the views' t_z, which are eliminated.
class ProfileEquations {
 public:
  void add(const Explanation& view, const RadialProfile* profile) {
    Eigen::Vector3d B = Eigen::Vector3d::Zero();
    double C = 0.0;
    double b = 0.0;
    for (const RadialSample& s : *view.samples) {
      const double weight = profile == nullptr ? 1.0 / (s.distance * s.distance) : sampleWeight(s, view, *profile);
      const double r2 = s.r * s.r;
      const Eigen::Vector3d row = s.distance * Eigen::Vector3d(1.0, r2, r2 * r2);
      A_ += weight * row * row.transpose();
      B -= weight * s.r * row;
      C += weight * r2;
      a_ += weight * s.r * s.depth * row;
      b -= weight * r2 * s.depth;
    }
    A_ -= B * B.transpose() / C;
    a_ -= B * b / C;
  }

  RadialProfile solve() const { return {A_.ldlt().solve(a_)}; }

 private:
  /// Turns the equation's residual into a radial error in the image, and lowers the weight of large ones.
  static double sampleWeight(const RadialSample& s, const Explanation& view, const RadialProfile& profile) {
    const double gain = s.r / (s.distance * profile.growth(s.r));
    const double residual = s.distance * profile.psi(s.r) - s.r * (s.depth + view.t_z);
    constexpr double kMinScale = 1e-3;
    return gain * gain * cauchyWeight(gain * residual, std::max(2.0 * view.error, kMinScale));
  }

  Eigen::Matrix3d A_ = Eigen::Matrix3d::Zero();
  Eigen::Vector3d a_ = Eigen::Vector3d::Zero();
};

ScoredProfile scored(const RadialProfile& profile, const std::vector<ProfileView>& views, double max_radius) {
  return {profile, isMonotone(profile, max_radius) ? meanCapped(explainAll(profile, views)) : kInfinity};
}

/// Starts that were refined to the same minimum.
bool isSameLens(const ScoredProfile& a, const ScoredProfile& b) {
  constexpr double kSame = 0.03;
  return std::abs(a.profile.coefficients(0) - b.profile.coefficients(0)) < kSame * a.profile.coefficients(0);
}

/// Refits to all views that agree, as long as that helps.
ScoredProfile refine(ScoredProfile best, const std::vector<ProfileView>& views, double max_radius) {
  constexpr int kMaxRounds = 10;
  for (int round = 0; round < kMaxRounds; ++round) {
    ProfileEquations equations;
    for (const Explanation& view : explainAll(best.profile, views)) {
      if (view.error < kMaxError) {
        equations.add(view, &best.profile);
      }
    }
    const ScoredProfile next = scored(equations.solve(), views, max_radius);
    if (!(next.score < best.score)) {
      break;
    }
    best = next;
  }
  return best;
}

/// Least squares on one view under one rotation.
RadialProfile profileFromView(const Samples& samples) {
  ProfileEquations equations;
  Explanation view;
  view.samples = &samples;
  equations.add(view, nullptr);
  return equations.solve();
}

/// Perspective, stereographic and (to fourth order) equidistant lens of focal length f.
std::array<RadialProfile, 3> idealLenses(double f) {
  return {RadialProfile{{f, 0.0, 0.0}}, RadialProfile{{f, -1.0 / (4.0 * f), 0.0}},
          RadialProfile{{f, -1.0 / (3.0 * f), -1.0 / (45.0 * f * f * f)}}};
}

/// Focal lengths in half widths, from a stereographic lens of 260 degrees to a perspective one of 30 degrees.
std::vector<double> coarseFocalLengths() {
  constexpr double kSmallest = 0.2;
  constexpr double kLargest = 4.0;
  constexpr double kRatio = 1.25;
  std::vector<double> result;
  for (double f = kSmallest; f < kLargest; f *= kRatio) {
    result.push_back(f);
  }
  return result;
}

}  // namespace

bool isMonotone(const RadialProfile& profile, double max_radius) {
  constexpr int kSteps = 32;
  // Where the angle hardly grows any more a pixel sees nearly nothing: no lens does that to half an image.
  constexpr double kMinGrowth = 0.02;
  if (!profile.coefficients.allFinite() || profile.coefficients(0) <= 0.0) {
    return false;
  }
  for (int i = 1; i <= kSteps; ++i) {
    const double r = max_radius * i / kSteps;
    const double psi = profile.psi(r);
    const double slope_rad = profile.growth(r) / (r * r + psi * psi);
    if (!(slope_rad * profile.coefficients(0) > kMinGrowth)) {
      return false;
    }
  }
  return true;
}

std::optional<ProfileView> profileView(const NormalView& view, const Eigen::Vector2d& centre, const RadialHomography& H) {
  std::vector<double> errors;
  const NormalView corners = spread(view, kMaxSamples);
  for (const NormalCorner& corner : corners) {
    errors.push_back(radialError(H, centre, corner));
  }
  constexpr double kMinLimit = 5e-3;
  const double limit = std::max(4.0 * upperMedian(errors), kMinLimit);
  const std::array<RadialPose, 2> poses = completeRotation(H);
  ProfileView result;
  for (const NormalCorner& corner : corners) {
    const Eigen::Vector2d x = corner.image - centre;
    if (radialError(H, centre, corner) > limit || x.dot(H * corner.board.homogeneous()) <= 0.0) {
      continue;
    }
    for (std::size_t i = 0; i < 2; ++i) {
      const Eigen::Vector3d rotated = poses[i].R_columns * corner.board;
      const double distance = (rotated.head<2>() + poses[i].t).norm();
      result.samples[i].push_back({x.norm(), std::max(distance, kMinDistance), rotated.z()});
    }
  }
  if (2 * result.samples[0].size() < corners.size() || result.samples[0].empty()) {
    return std::nullopt;
  }
  return result;
}

double maxRadius(const std::vector<ProfileView>& views) {
  double radius = 0.0;
  for (const ProfileView& view : views) {
    for (const RadialSample& sample : view.samples[0]) {
      radius = std::max(radius, sample.r);
    }
  }
  return radius;
}

std::vector<ScoredProfile> searchProfiles(const std::vector<ProfileView>& views, std::optional<double> focal_hint,
                                          std::size_t max_profiles) {
  if (views.empty()) {
    return {};
  }
  const double max_radius = maxRadius(views);
  std::vector<RadialProfile> candidates;
  for (const ProfileView& view : views) {
    candidates.push_back(profileFromView(view.samples[0]));
    candidates.push_back(profileFromView(view.samples[1]));
  }
  std::vector<double> focal_lengths = coarseFocalLengths();
  if (focal_hint) {
    focal_lengths.push_back(*focal_hint);
  }
  for (const double f : focal_lengths) {
    for (const RadialProfile& ideal : idealLenses(f)) {
      candidates.push_back(ideal);
    }
  }
  std::vector<ScoredProfile> profiles;
  for (const RadialProfile& candidate : candidates) {
    profiles.push_back(scored(candidate, views, max_radius));
    if (!(profiles.back().score < kInfinity)) {
      profiles.pop_back();
    }
  }
  const auto is_better = [](const ScoredProfile& a, const ScoredProfile& b) { return a.score < b.score; };
  std::stable_sort(profiles.begin(), profiles.end(), is_better);
  profiles.resize(std::min(profiles.size(), max_profiles));
  for (ScoredProfile& profile : profiles) {
    profile = refine(profile, views, max_radius);
  }
  std::stable_sort(profiles.begin(), profiles.end(), is_better);
  const auto last = std::unique(profiles.begin(), profiles.end(), isSameLens);
  profiles.erase(last, profiles.end());
  return profiles;
}

}  // namespace tartan_calib::calibration
