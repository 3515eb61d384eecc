#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include "radial_pose.h"

namespace tartan_calib::calibration {

/// Even division model of a lens (Fitzgibbon 2001): the pixel at distance r from the distortion centre in direction (x, y)
/// sees along (x, y, psi(r)), psi(r) = c0 + c1 r^2 + c2 r^4. Any central lens below 360 degrees.
struct RadialProfile {
  Eigen::Vector3d coefficients = Eigen::Vector3d::Zero();

  double psi(double r) const { return coefficients(0) + r * r * (coefficients(1) + r * r * coefficients(2)); }
  /// psi - r psi', positive where the angle from the axis grows with the radius.
  double growth(double r) const { return coefficients(0) - r * r * (coefficients(1) + 3.0 * r * r * coefficients(2)); }
  double angle(double r) const { return std::atan2(r, psi(r)); }
};

/// The angle grows all the way to `max_radius`, from a positive focal length.
bool isMonotone(const RadialProfile& profile, double max_radius);

/// A corner as the profile sees it: radius in the image; distance from the axis and depth of the board point, the latter
/// without the board's distance along the axis.
struct RadialSample {
  double r;
  double distance;
  double depth;
};

/// One view under each of its two rotations; corners off their half-lines are left out.
struct ProfileView {
  std::array<std::vector<RadialSample>, 2> samples;
};

/// Empty where less than half of the corners agree with the homography.
std::optional<ProfileView> profileView(const NormalView& view, const Eigen::Vector2d& centre, const RadialHomography& H);

/// Largest image radius of all samples.
double maxRadius(const std::vector<ProfileView>& views);

struct ScoredProfile {
  RadialProfile profile;
  double score = 0.0;  ///< mean over the views of the median radial error, each capped; image units
};

/// The profile that explains most views: estimates from single views and a coarse family of ideal lenses, refined on all
/// views that agree. `focal_hint`: a further focal length for the family. Sorted, best first; at most `max_profiles`, only
/// such as are monotone over all radii seen.
std::vector<ScoredProfile> searchProfiles(const std::vector<ProfileView>& views, std::optional<double> focal_hint,
                                          std::size_t max_profiles);

}  // namespace tartan_calib::calibration
