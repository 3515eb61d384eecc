#pragma once

#include <Eigen/Core>
#include <functional>
#include <opencv2/core.hpp>
#include <optional>

namespace tartan_calib::detection {

/// Where points of the board around a corner are seen: offset on the board from the corner (any unit) to offset from the
/// corner's pixel [px]. A map from a calibrated model is the best; the homography of a tag will do without.
using BoardToPixelOffset = std::function<Eigen::Vector2d(const Eigen::Vector2d& board_offset)>;

struct RefineOptions {
  double half_window = 0.15;  ///< on the board, in the map's unit: only the corner itself may be inside
  double scale_px =
      1.0;  ///< finest detail of the image, as Saddle::scale_px: bounds below and spacing of samples grow with it
  double min_half_window_px = 1.8;  ///< the window grows to this
  double max_half_window_px = 8.0;  ///< and shrinks to this
  double max_shift_px = 1.5;        ///< from the start
  int max_iterations = 12;
  double min_contrast = 4.0;         ///< [grey levels] within the window
  double max_residual_ratio = 0.25;  ///< rms asymmetry that is left, in units of the contrast
  /// Takes a smaller window where something else than the corner is in this one.
  bool may_shrink = true;
};

struct RefinedCorner {
  Eigen::Vector2d px = Eigen::Vector2d::Zero();
  Eigen::Matrix2d cov_px2 = Eigen::Matrix2d::Identity();
  double residual_ratio = 0.0;  ///< rms asymmetry that is left, in units of the contrast
};

/// The point around which the image is symmetric: minimises over c the sum of (I(c + p(s)) - I(c + p(-s)))^2, s over a half
/// window of the board. Blur does not move it, bloom neither; light that changes linearly is estimated with it. At the
/// border of the image only pairs that are inside count. Nothing where the window is empty or not symmetric around any point
/// near.
std::optional<RefinedCorner> refineBySymmetry(const cv::Mat& gray, const Eigen::Vector2d& start_px,
                                              const BoardToPixelOffset& map, const RefineOptions& options = {});

}  // namespace tartan_calib::detection
