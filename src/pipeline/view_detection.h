#pragma once

#include <vector>

#include "tartan_calib/detection/target_detector.h"
#include "tartan_calib/observation/observation.h"
#include "tartan_calib/pipeline/virtual_view.h"
#include "tartan_calib/target/target.h"

namespace tartan_calib::pipeline {

/// Detects a board in virtual views of one camera's images. The tables of the views are made once, for all images; const
/// afterwards, for all threads.
class ViewDetection {
 public:
  ViewDetection(const camera::Camera& camera, const target::Target& target, const Projections& projections,
                const detection::DetectorOptions& options);

  bool empty() const { return views_.empty() && !rectified_; }

  /// Corners in pixels of the image, good to about a pixel of a view. A corner that several views show is there several
  /// times.
  std::vector<observation::Corner> detect(const cv::Mat& gray) const;

  /// The same in the view rectified on the board at T_cam_target, where that is asked for.
  std::vector<observation::Corner> detectRectified(const cv::Mat& gray, const geometry::Rigid3& T_cam_target) const;

 private:
  std::vector<observation::Corner> detectIn(const VirtualView& view, const cv::Mat& gray) const;

  camera::Camera camera_;
  std::vector<Eigen::Vector3d> target_points_;
  detection::TargetDetector detector_;
  std::vector<VirtualView> views_;
  std::optional<ViewSize> rectified_;
};

}  // namespace tartan_calib::pipeline
