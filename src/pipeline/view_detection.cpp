#include "view_detection.h"

#include <utility>

namespace tartan_calib::pipeline {

using observation::Corner;

ViewDetection::ViewDetection(const camera::Camera& camera, const target::Target& target, const Projections& projections,
                             const detection::DetectorOptions& options)
    : camera_(camera),
      target_points_(target::cornerPoints(target)),
      detector_(target, options),
      rectified_(projections.rectified) {
  for (const VirtualPinhole& pinhole : projections.pinholes) {
    views_.emplace_back(camera, pinhole);
  }
}

std::vector<Corner> ViewDetection::detectIn(const VirtualView& view, const cv::Mat& gray) const {
  std::vector<Corner> corners;
  for (const Corner& seen : detector_.detect(view.remap(gray)).corners) {
    const auto px = view.toImage(seen.px);
    if (px && camera::isInside(camera_, *px)) {
      corners.push_back({seen.corner_id, *px});
    }
  }
  return corners;
}

std::vector<Corner> ViewDetection::detect(const cv::Mat& gray) const {
  std::vector<Corner> corners;
  for (const VirtualView& view : views_) {
    const std::vector<Corner> seen = detectIn(view, gray);
    corners.insert(corners.end(), seen.begin(), seen.end());
  }
  return corners;
}

std::vector<Corner> ViewDetection::detectRectified(const cv::Mat& gray, const geometry::Rigid3& T_cam_target) const {
  if (!rectified_) {
    return {};
  }
  const auto pinhole = rectifiedView(T_cam_target, target_points_, rectified_->width, rectified_->height);
  return pinhole ? detectIn(VirtualView(camera_, *pinhole), gray) : std::vector<Corner>();
}

}  // namespace tartan_calib::pipeline
