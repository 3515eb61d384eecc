#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <vector>

#include "tartan_calib/observation/observation.h"

/// The part of a board's pose that holds whatever the lens' radial profile: an image point, seen from the distortion centre,
/// lies in the direction of the first two camera coordinates of its board point (radial 1D constraint; Thirthala and
/// Pollefeys 2005, Lochman et al. 2021).
namespace tartan_calib::calibration {

/// A corner in units that make all views of all cameras alike: image by half its width, board by its size.
struct NormalCorner {
  Eigen::Vector2d image;
  Eigen::Vector2d board;
};

using NormalView = std::vector<NormalCorner>;

/// First two rows of [r1 r2 t] of T_cam_target up to a positive factor: (image - centre) ~ H [board; 1].
using RadialHomography = Eigen::Matrix<double, 2, 3>;

/// Distance of a corner from the half-line on which the homography expects it; from the centre where it lies on the other
/// half.
double radialError(const RadialHomography& H, const Eigen::Vector2d& centre, const NormalCorner& corner);

/// Least median of errors over random samples, then least squares on those that agree. Empty below 6 corners.
std::optional<RadialHomography> searchRadialHomography(const NormalView& view, const Eigen::Vector2d& centre);

/// Robust least squares from a near homography.
RadialHomography refineRadialHomography(const NormalView& view, const Eigen::Vector2d& centre, const RadialHomography& H);

/// Pose without the distance along the optical axis, which the constraint leaves open.
struct RadialPose {
  Eigen::Matrix<double, 3, 2> R_columns;  ///< r1, r2 of R_cam_target
  Eigen::Vector2d t;                      ///< first two of t_cam_target
};

/// The two rotations that have these rows, mirror images in depth of each other.
std::array<RadialPose, 2> completeRotation(const RadialHomography& H);

/// Mean robust cost of the view, between 0 and about 10.
double radialCost(const RadialHomography& H, const Eigen::Vector2d& centre, const NormalView& view);

}  // namespace tartan_calib::calibration
