#pragma once

#include "tartan_calib/calibration/board_bend.h"
#include "tartan_calib/camera/camera.h"
#include "tartan_calib/detection/board_map.h"
#include "tartan_calib/geometry/rigid3.h"

namespace tartan_calib::pipeline {

/// Of the board: flat where warp_m is 0.
struct BoardShape {
  calibration::BoardBend bend;
  Eigen::Vector2d warp_m = Eigen::Vector2d::Zero();
};

/// From the flat board through its curvature, the pose and the lens.
detection::BoardMap boardMap(const camera::Camera& camera, const geometry::Rigid3& T_cam_target, const BoardShape& shape);

}  // namespace tartan_calib::pipeline
