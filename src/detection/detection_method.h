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

/// The whole board must be in the image, since nothing else tells its corners apart, but single corners may be hidden; see
/// placeOnBoard for how they are numbered. Two boards of the same size are two copies of one target: neither is used.
std::unique_ptr<const DetectionMethod> makeCheckerboardMethod(const target::Checkerboard& board,
                                                              const DetectorOptions& options);

/// Centres of dark circles, found by OpenCV: all of them or none. A grid looks the same after half a turn, a square one
/// after a quarter too, so that numbers may change from image to image; they are never mirrored.
std::unique_ptr<const DetectionMethod> makeCircleGridMethod(const target::CircleGrid& grid, const DetectorOptions& options);

}  // namespace tartan_calib::detection
