#pragma once

#include <Eigen/Core>
#include <vector>

#include "tartan_calib/camera/camera.h"
#include "tartan_calib/geometry/rigid3.h"
#include "tartan_calib/target/target.h"

namespace tartan_calib::simulation {

/// Variance that says that pixels do not determine a corner; a thousand pixels are as good as anywhere.
constexpr double kNoInformationPx2 = 1e6;

/// Where a corner of the board really is in an image. One that is neither visible nor hidden is in the picture, but too
/// close to its border, to the circle's or to an occluder's for anybody to be blamed who does not find it.
struct TrueCorner {
  int corner_id = -1;
  Eigen::Vector2d px = Eigen::Vector2d::Zero();
  bool visible = true;                 ///< inside of the image and of the lens' circle, and clear of occluders
  bool hidden = false;                 ///< not in the picture: outside of the lens' circle, or behind an occluder
  double neighbour_distance_px = 0.0;  ///< to the nearest other corner of the board
  double motion_px = 0.0;              ///< from where it is at the start of the exposure to where at the end
  /// Cramer-Rao bound: no unbiased estimate from the pixels around this corner can have a smaller covariance. Known for
  /// the pictures of a Renderer only.
  Eigen::Matrix2d bound_px2 = kNoInformationPx2 * Eigen::Matrix2d::Identity();
};

/// Corners must be so far inside of the image and of the lens' circle to count as visible.
constexpr double kMinBorderDistancePx = 2.0;

/// The corners that the camera images within its width and height, by increasing id; none where it is behind the board.
/// `visible` knows of the image's border only.
std::vector<TrueCorner> projectCorners(const target::Target& target, const camera::Camera& camera,
                                       const geometry::Rigid3& T_cam_target);

}  // namespace tartan_calib::simulation
