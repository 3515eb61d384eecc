#include "window_covariance.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>

#include "cubic_spline.h"
#include "light_slope.h"

namespace tartan_calib::detection {
namespace {

constexpr int kTaps = 4;
constexpr double kRoundingVariance = 1.0 / 12.0;  ///< [grey levels^2]: pixels are integers

using Grid = Eigen::ArrayXXd;  ///< (row, column)

double dot(const Grid& a, const Grid& b) { return (a * b).sum(); }

/// Sum of a * b over every cell, for each a and b.
template <std::size_t kRows, std::size_t kCols>
Eigen::Matrix<double, kRows, kCols> products(const std::array<Grid, kRows>& rows, const std::array<Grid, kCols>& cols) {
  Eigen::Matrix<double, kRows, kCols> result;
  for (std::size_t row = 0; row < kRows; ++row) {
    for (std::size_t col = 0; col < kCols; ++col) {
      result(static_cast<Eigen::Index>(row), static_cast<Eigen::Index>(col)) = dot(rows[row], cols[col]);
    }
  }
  return result;
}

/// What half a turn about the middle changes.
Grid changeUnderHalfTurn(const Grid& grid) { return grid - grid.reverse(); }

/// Weights of four pixels in a row for a sample between the middle ones, and their derivatives.
struct Kernel {
  Eigen::Array4d weights;
  Eigen::Array4d slopes;
};

using Interpolation = Kernel (*)(double fraction);

Kernel bilinear(double fraction) { return {{0.0, 1.0 - fraction, fraction, 0.0}, {0.0, -1.0, 1.0, 0.0}}; }

Kernel spline(double fraction) {
  const auto t = static_cast<float>(fraction);
  return {splineWeights(t).cast<double>(), splineSlopes(t).cast<double>()};
}

/// Grey values at whole-pixel steps around a point between pixels, and what they change by when the point moves [1/px].
struct Window {
  Grid gray;
  std::array<Grid, 2> slope;  ///< along x, along y
};

/// The pixels behind a window's samples; outside of the image its border goes on.
class Pixels {
 public:
  Pixels(const cv::Mat& gray, const Eigen::Vector2d& centre_px, int reach_px)
      : size_(2 * reach_px + 1), values_(size_ + kTaps - 1, size_ + kTaps - 1) {
    const Eigen::Vector2d whole_px = centre_px.array().floor();
    fraction_ = centre_px - whole_px;
    const int left = static_cast<int>(whole_px.x()) - reach_px - 1;
    const int top = static_cast<int>(whole_px.y()) - reach_px - 1;
    for (Eigen::Index col = 0; col < values_.cols(); ++col) {
      for (Eigen::Index row = 0; row < values_.rows(); ++row) {
        values_(row, col) = gray.at<std::uint8_t>(std::clamp(top + static_cast<int>(row), 0, gray.rows - 1),
                                                  std::clamp(left + static_cast<int>(col), 0, gray.cols - 1));
      }
    }
  }

  Window window(Interpolation kernel) const {
    const Kernel x = kernel(fraction_.x());
    const Kernel y = kernel(fraction_.y());
    return {sample(x.weights, y.weights), {sample(x.slopes, y.weights), sample(x.weights, y.slopes)}};
  }

  /// Variance of a sample where that of a pixel is 1.
  double sampleVariance(Interpolation kernel) const {
    return kernel(fraction_.x()).weights.square().sum() * kernel(fraction_.y()).weights.square().sum();
  }

  /// What every pixel counts in a sum of samples with the given factors.
  Grid weightsOf(const Grid& factors, Interpolation kernel) const {
    const Eigen::Array4d x = kernel(fraction_.x()).weights;
    const Eigen::Array4d y = kernel(fraction_.y()).weights;
    Grid rows = Grid::Zero(values_.rows(), size_);
    Grid weights = Grid::Zero(values_.rows(), values_.cols());
    for (int i = 0; i < kTaps; ++i) {
      rows.middleRows(i, size_) += y[i] * factors;
    }
    for (int i = 0; i < kTaps; ++i) {
      weights.middleCols(i, size_) += x[i] * rows;
    }
    return weights;
  }

 private:
  Grid sample(const Eigen::Array4d& x, const Eigen::Array4d& y) const {
    Grid rows = Grid::Zero(values_.rows(), size_);
    Grid samples = Grid::Zero(size_, size_);
    for (int i = 0; i < kTaps; ++i) {
      rows += x[i] * values_.middleCols(i, size_);
    }
    for (int i = 0; i < kTaps; ++i) {
      samples += y[i] * rows.middleRows(i, size_);
    }
    return samples;
  }

  int size_;
  Grid values_;
  Eigen::Vector2d fraction_ = Eigen::Vector2d::Zero();
};

/// Derivatives with respect to the grey values of f = sum w g (g . r), which the iteration brings to 0; r runs over the
/// window, g is the central difference there, w a Gaussian.
std::array<Grid, 2> derivatives(const Grid& gray) {
  const Eigen::Index size = gray.rows() - 2;
  const double half_window_px = 0.5 * static_cast<double>(size - 1);
  const Eigen::ArrayXd along = Eigen::ArrayXd::LinSpaced(size, -half_window_px, half_window_px);
  const Eigen::ArrayXd fall = (-(along / half_window_px).square()).exp();
  const Grid x = along.transpose().replicate(size, 1);
  const Grid y = along.replicate(1, size);
  const Grid weight = (fall.matrix() * fall.matrix().transpose()).array();
  const Grid gx = gray.block(1, 2, size, size) - gray.block(1, 0, size, size);
  const Grid gy = gray.block(2, 1, size, size) - gray.block(0, 1, size, size);
  const Grid across = gx * x + gy * y;
  const std::array<Grid, 2> by_gx = {weight * (across + gx * x), weight * gy * x};
  const std::array<Grid, 2> by_gy = {weight * gx * y, weight * (across + gy * y)};
  std::array<Grid, 2> by_gray;
  for (std::size_t i = 0; i < by_gray.size(); ++i) {
    by_gray[i] = Grid::Zero(gray.rows(), gray.cols());
    by_gray[i].block(1, 2, size, size) += by_gx[i];
    by_gray[i].block(1, 0, size, size) -= by_gx[i];
    by_gray[i].block(2, 1, size, size) += by_gy[i];
    by_gray[i].block(0, 1, size, size) -= by_gy[i];
  }
  return by_gray;
}

/// Variance of a pixel [grey levels^2]. Half a turn about a corner leaves its window as it is: what differs is noise, but
/// for what a shift of the corner and a slope of light explain.
double noiseVariance(const Pixels& pixels, const Window& window) {
  constexpr double kMinFreedom = 1.0;
  const Eigen::Index size = window.gray.rows();
  const double reach_px = 0.5 * static_cast<double>(size - 1);
  const Eigen::ArrayXd along = Eigen::ArrayXd::LinSpaced(size, -reach_px, reach_px);
  const Grid mean = 0.5 * (window.gray + window.gray.reverse());
  const std::array<Grid, 1> difference = {changeUnderHalfTurn(window.gray)};
  const std::array<Grid, 4> causes = {changeUnderHalfTurn(window.slope[0]), changeUnderHalfTurn(window.slope[1]),
                                      along.transpose().replicate(size, 1) * mean, along.replicate(1, size) * mean};
  std::array<Grid, 4> pixel_weights;
  std::transform(causes.begin(), causes.end(), pixel_weights.begin(),
                 [&](const Grid& cause) { return pixels.weightsOf(cause, spline); });
  // Each pair of samples is in the sums twice.
  Eigen::Matrix4d normal = 0.5 * products(causes, causes);
  normal.diagonal().tail<2>().array() += kLightSlopePrior;
  const Eigen::Vector4d right = 0.5 * products(causes, difference);
  const auto decomposition = normal.ldlt();
  const double left = 0.5 * dot(difference[0], difference[0]) - right.dot(decomposition.solve(right));
  const double freedom = static_cast<double>(size * size - 1) * pixels.sampleVariance(spline) -
                         decomposition.solve(products(pixel_weights, pixel_weights)).trace();
  return std::max(kRoundingVariance, left / std::max(kMinFreedom, freedom));
}

}  // namespace

Eigen::Matrix2d windowCovariance(const cv::Mat& gray, const Eigen::Vector2d& px, int half_window_px) {
  const int reach_px = half_window_px + 1;  // for the gradient
  const Pixels pixels(gray, px, reach_px);
  const Window window = pixels.window(bilinear);
  const Window smooth = pixels.window(spline);
  const std::array<Grid, 2> by_gray = derivatives(window.gray);
  const std::array<Grid, 2> by_pixel = {pixels.weightsOf(by_gray[0], bilinear), pixels.weightsOf(by_gray[1], bilinear)};
  const Eigen::Matrix2d gain = products(by_gray, window.slope).inverse();
  const Eigen::Matrix2d from_noise = noiseVariance(pixels, smooth) * gain * products(by_pixel, by_pixel) * gain.transpose();
  // Bilinear weights have an odd third moment and move edges between pixels by up to 0.04 px; and the iteration ends where
  // its steps are short. The spline has no such moment: its step to where its own f is 0 tells both.
  const std::array<Grid, 2> by_smooth = derivatives(smooth.gray);
  const Eigen::Vector2d f = 0.5 * products(by_smooth, std::array<Grid, 1>{smooth.gray});  // quadratic in the grey values
  const Eigen::Vector2d step_px = products(by_smooth, smooth.slope).inverse() * f;
  return from_noise + step_px * step_px.transpose();
}

}  // namespace tartan_calib::detection
