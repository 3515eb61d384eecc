#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <vector>

#include "cubic_spline.h"

namespace tartan_calib::detection {

/// Grey values around a point, seen through the cubic B-spline as a low-pass (standard deviation 0.58 px): twice
/// differentiable, and blind to what the pixel grid has folded, so that differences of samples know nothing of the grid.
/// Interpolation through the grey values has that in full. Outside of the image its border goes on.
class Patch {
 public:
  /// Square of half-size `reach_px` around `centre` (rounded), low-passed further by `blur_px` where that is more than 0.
  Patch(const cv::Mat& gray, const Eigen::Vector2d& centre, double reach_px, double blur_px);

  struct Sample {
    float gray;
    float slope_x;  ///< [grey levels/px]
    float slope_y;
  };

  Sample at(const Eigen::Vector2f& px) const {
    const Cell cell = cellOf(px);
    const Eigen::Array4f weight_x = splineWeights(cell.fraction.x());
    const Eigen::Array4f weight_y = splineWeights(cell.fraction.y());
    const Eigen::Array4f slope_y = splineSlopes(cell.fraction.y());
    const float* line = values_.data() + cell.index;
    Eigen::Array4f value = Eigen::Array4f::Zero();
    Eigen::Array4f slope = Eigen::Array4f::Zero();
    for (int i = 0; i < kTaps; ++i, line += cols_) {
      const Eigen::Array4f pixels = Eigen::Map<const Eigen::Array4f>(line);
      value += weight_y[i] * pixels;
      slope += slope_y[i] * pixels;
    }
    return {(weight_x * value).sum(), (splineSlopes(cell.fraction.x()) * value).sum(), (weight_x * slope).sum()};
  }

  /// True if `at` is possible for all points within `reach_px` of `px` along each axis.
  bool holds(const Eigen::Vector2d& px, double reach_px) const;

  /// Second moment, along an axis, of what a sample averages light over: pixel, spline and blur [px^2].
  double spread_px2() const { return spread_px2_; }

  /// Variance of a sample where that of a pixel is 1.
  double noiseGain(const Eigen::Vector2f& px) const;

  /// Two linear combinations of samples, pixel by pixel, to carry the noise of the pixels through them.
  class PixelWeights {
   public:
    /// Keeps a reference.
    explicit PixelWeights(const Patch& patch);

    /// Adds a sample, times `factor`, to the two sums.
    void add(const Eigen::Vector2f& px, const Eigen::Vector2f& factor);

    /// Covariance of the two sums where the variance of a pixel is 1.
    Eigen::Matrix2d covariance() const;

   private:
    const Patch& patch_;
    std::vector<float> first_;
    std::vector<float> second_;
  };

 private:
  static constexpr int kTaps = 4;

  struct Cell {
    int index;  ///< of the first pixel with a weight
    Eigen::Vector2f fraction;
  };

  Cell cellOf(const Eigen::Vector2f& px) const {
    const Eigen::Vector2f local = px - origin_;
    const int x = static_cast<int>(local.x());
    const int y = static_cast<int>(local.y());
    return {(y - 1) * cols_ + x - 1, local - Eigen::Vector2f(static_cast<float>(x), static_cast<float>(y))};
  }

  int cols_ = 0;
  int rows_ = 0;
  double spread_px2_ = 0.0;
  Eigen::Vector2f origin_ = Eigen::Vector2f::Zero();
  std::vector<float> half_blur_;      ///< half of the kernel of the blur, the middle first
  Eigen::Matrix4f blur_correlation_;  ///< of the noise of four pixels in a row after the blur, along one axis
  std::vector<float> values_;
};

}  // namespace tartan_calib::detection
