#pragma once

#include <Eigen/Core>
#include <vector>

#include "tartan_calib/camera/camera.h"

namespace tartan_calib::calibration {

/// A direction in the camera frame and where it is seen.
struct RayPixel {
  Eigen::Vector3d ray;
  Eigen::Vector2d px;
};

/// Models of the given kind that send the rays to the pixels, by least squares within the model's bounds: the best one, then
/// those of other minima that are nearly as good (the double sphere has two). Starts from camera::startModel at several
/// focal lengths; rays that such a start cannot see, or only far out, are left out.
std::vector<camera::CameraModel> fitModels(const camera::CameraModel& kind, double focal_px,
                                           const Eigen::Vector2d& principal_point_px, const std::vector<RayPixel>& pairs);

}  // namespace tartan_calib::calibration
