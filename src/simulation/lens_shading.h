#pragma once

#include <opencv2/core.hpp>

#include "tartan_calib/simulation/scene.h"

namespace tartan_calib::simulation {

Eigen::Vector2d principalPoint(const camera::Camera& camera);

/// Light that each pixel gets, as a part of that at the principal point: the lens' fall-off and its image circle. CV_32FC1.
cv::Mat1f lensShading(const SceneCamera& camera);

/// Distance [px] from the edge of the lens' image circle, positive inside; infinite for a lens that fills the sensor.
double distanceInsideCircle(const SceneCamera& camera, const Eigen::Vector2d& px);

/// Light on the board as the camera sees it, as a part of full light: lamp, ambient and the paper's sheen. Smooth, and so
/// evaluated on a coarse grid only.
class BoardLight {
 public:
  BoardLight(const SceneCamera& camera, const Lighting& lighting);

  /// CV_32FC1 of the image's size; for a board with normal `normal_cam` towards its front.
  cv::Mat1f onBoard(const Eigen::Vector3d& normal_cam) const;

 private:
  cv::Size size_;
  Lighting lighting_;
  Eigen::Vector3d lamp_cam_;
  cv::Mat3f rays_cam_;  ///< zero where the model has no ray
};

}  // namespace tartan_calib::simulation
