#pragma once

#include <memory>
#include <opencv2/core.hpp>

#include "tartan_calib/detection/target_detector.h"

namespace tartan_calib::detection {

/// How one type of target is found. Stateless between images.
class DetectionMethod {
 public:
  DetectionMethod() = default;
  DetectionMethod(const DetectionMethod&) = delete;
  DetectionMethod& operator=(const DetectionMethod&) = delete;
  virtual ~DetectionMethod() = default;

  virtual Detection detect(const cv::Mat& gray) const = 0;
};

std::unique_ptr<const DetectionMethod> makeAprilGridMethod(const target::AprilGrid& grid, const DetectorOptions& options);

}  // namespace tartan_calib::detection
