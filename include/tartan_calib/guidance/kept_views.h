#pragma once

#include <cstddef>
#include <cstdint>
#include <opencv2/core.hpp>
#include <optional>
#include <vector>

#include "tartan_calib/geometry/rigid3.h"
#include "tartan_calib/observation/observation.h"

namespace tartan_calib::guidance {

/// An image as PNG: half of its size, and every pixel as it was.
struct EncodedImage {
  int camera_index = 0;
  std::int64_t stamp_ns = 0;
  std::vector<unsigned char> png;

  cv::Mat decode() const;
};

struct KeptView {
  observation::View view;
  std::vector<EncodedImage> images;
  double blur_px = 0.0;                          ///< of the most blurred image
  std::optional<geometry::Rigid3> T_rig_target;  ///< once there is a calibration
  Eigen::MatrixXd information;                   ///< calibration::viewInformation, likewise; empty without a pose
};

/// `gray`: CV_8UC1.
EncodedImage encodeImage(int camera_index, std::int64_t stamp_ns, const cv::Mat& gray);

std::size_t encodedBytes(const KeptView& kept);

/// How far the board's corners are apart in two views, as a share of `diagonals_px` (by camera): the median over the corners
/// of both, of the camera where that is largest. 1 where the views have no corner in common.
double viewChange(const observation::View& a, const observation::View& b, const std::vector<double>& diagonals_px);

}  // namespace tartan_calib::guidance
