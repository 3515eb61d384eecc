#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "live/image_input.h"
#include "tartan_calib/detection/target_detector.h"
#include "tartan_calib/observation/observation.h"

namespace tartan_calib::apps {

/// An image and the corners in it.
struct DetectedImage {
  int camera_index = 0;
  std::int64_t stamp_ns = 0;
  cv::Mat gray;                   ///< CV_8UC1; empty where the image could not be read
  std::string unreadable_reason;  ///< then
  std::vector<observation::Corner> corners;
};

/// Decodes images and finds the board, each on a thread of its own. An image that cannot be read is no reason to end.
std::vector<DetectedImage> detectImages(const detection::TargetDetector& detector, const std::vector<ArrivedImage>& images);

}  // namespace tartan_calib::apps
