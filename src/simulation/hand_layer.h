#pragma once

#include <opencv2/core.hpp>

#include "tartan_calib/camera/camera.h"
#include "tartan_calib/geometry/rigid3.h"
#include "tartan_calib/simulation/scene.h"

namespace tartan_calib::simulation {

/// A hand as a camera sees it at one moment, before blur. Empty matrices where it is out of view.
struct HandLayer {
  cv::Rect window;
  cv::Mat1f cover;  ///< covered part of each pixel
  cv::Mat1f light;  ///< grey level of what covers it, times `cover`
};

HandLayer drawHand(const Hand& hand, const camera::Camera& camera, const geometry::Rigid3& T_cam_target);

}  // namespace tartan_calib::simulation
