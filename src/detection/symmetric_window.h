#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <optional>
#include <vector>

#include "tartan_calib/detection/refine.h"

namespace tartan_calib::detection {

/// Pixel offsets of a board point and of its mirror image in the corner.
struct SamplePair {
  Eigen::Vector2f plus_px;
  Eigen::Vector2f minus_px;
};

struct SampleSet {
  std::vector<SamplePair> pairs;
  double pairs_per_px2 = 1.0;
  double reach_px = 0.0;  ///< of the farthest sample along an image axis
};

/// The part of the board around a corner that is compared with its half turn, as the image shows it.
class SymmetricWindow {
 public:
  /// Nothing where the map does not spread the window over a part of the image.
  static std::optional<SymmetricWindow> make(const BoardToPixelOffset& map, const RefineOptions& options);

  /// Samples of the window made smaller by `share`, but not below options.min_half_window_px, without pairs of which one
  /// lies outside of the image when the corner is at `centre_px`.
  SampleSet samples(double share, const Eigen::Vector2d& centre_px, const cv::Size& image) const;

 private:
  SymmetricWindow() = default;

  /// `uv` in half windows, -1 ... 1 along each axis of the board.
  Eigen::Vector2d at(double u, double v) const;

  Eigen::Matrix<double, 2, 9> coefficients_;  ///< of 1, u, u^2, v, uv, u^2 v, v^2, u v^2, u^2 v^2
  Eigen::Vector2d length_px_ = Eigen::Vector2d::Zero();
  double min_half_window_px_ = 0.0;
  double spacing_px_ = 1.0;
};

}  // namespace tartan_calib::detection
