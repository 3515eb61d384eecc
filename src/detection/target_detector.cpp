#include "tartan_calib/detection/target_detector.h"

#include "detection_method.h"
#include "tartan_calib/error.h"

namespace tartan_calib::detection {
namespace {

struct MethodFor {
  const DetectorOptions& options;

  std::unique_ptr<const DetectionMethod> operator()(const target::AprilGrid& grid) const {
    return makeAprilGridMethod(grid, options);
  }
  std::unique_ptr<const DetectionMethod> operator()(const target::Checkerboard& board) const {
    return makeCheckerboardMethod(board, options);
  }
  std::unique_ptr<const DetectionMethod> operator()(const target::CircleGrid& grid) const {
    return makeCircleGridMethod(grid, options);
  }
};

}  // namespace

DetectionCounts& DetectionCounts::operator+=(const DetectionCounts& more) {
  tags += more.tags;
  duplicate_tags += more.duplicate_tags;
  foreign_tags += more.foreign_tags;
  mirrored_tags += more.mirrored_tags;
  other_border_tags += more.other_border_tags;
  for (const auto& [size, num_images] : more.other_sizes) {
    other_sizes[size] += num_images;
  }
  return *this;
}

TargetDetector::TargetDetector(const target::Target& target, const DetectorOptions& options)
    : method_(std::visit(MethodFor{options}, target)) {}

TargetDetector::~TargetDetector() = default;
TargetDetector::TargetDetector(TargetDetector&&) noexcept = default;
TargetDetector& TargetDetector::operator=(TargetDetector&&) noexcept = default;

Detection TargetDetector::detect(const cv::Mat& gray) const {
  if (gray.type() != CV_8UC1) {
    throw InputError("the detector needs images with one channel of 8 bits; convert them first");
  }
  return method_->detect(gray);
}

}  // namespace tartan_calib::detection
