#include "patch.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>

namespace tartan_calib::detection {
namespace {

constexpr double kPixelSpread_px2 = 1.0 / 12.0;  // a square of side 1
constexpr double kSplineSpread_px2 = 1.0 / 3.0;  // four such squares, convolved
constexpr int kSpare_px = 2;                     // of a sample's weights beside its pixel

/// Half of a Gaussian whose sum is 1, the middle first.
std::vector<float> halfGaussian(double sigma_px) {
  constexpr double kReachInSigmas = 3.0;
  const int reach = sigma_px > 0.0 ? static_cast<int>(std::ceil(kReachInSigmas * sigma_px)) : 0;
  std::vector<float> half = {1.0F};
  float sum = 1.0F;
  for (int i = 1; i <= reach; ++i) {
    half.push_back(static_cast<float>(std::exp(-0.5 * i * i / (sigma_px * sigma_px))));
    sum += 2.0F * half.back();
  }
  for (float& weight : half) {
    weight /= sum;
  }
  return half;
}

float weightAt(const std::vector<float>& half_kernel, int offset) {
  const auto i = static_cast<std::size_t>(std::abs(offset));
  return i < half_kernel.size() ? half_kernel[i] : 0.0F;
}

Eigen::Matrix4f correlation(const std::vector<float>& half_kernel) {
  const int reach = static_cast<int>(half_kernel.size());
  Eigen::Vector4f by_distance = Eigen::Vector4f::Zero();
  for (int distance = 0; distance < by_distance.size(); ++distance) {
    for (int i = -reach; i <= reach; ++i) {
      by_distance[distance] += weightAt(half_kernel, i) * weightAt(half_kernel, i + distance);
    }
  }
  Eigen::Matrix4f matrix;
  for (int row = 0; row < matrix.rows(); ++row) {
    for (int col = 0; col < matrix.cols(); ++col) {
      matrix(row, col) = by_distance[std::abs(row - col)];
    }
  }
  return matrix;
}

/// Convolves along rows and columns; a margin as wide as the kernel keeps its values.
void blur(const std::vector<float>& half_kernel, int cols, std::vector<float>& values) {
  const int margin = static_cast<int>(half_kernel.size()) - 1;
  if (margin == 0) {
    return;
  }
  const int rows = static_cast<int>(values.size()) / cols;
  for (const int step : {1, cols}) {
    const std::vector<float> source = values;
    for (int y = margin; y < rows - margin; ++y) {
      for (int x = margin; x < cols - margin; ++x) {
        const float* from = source.data() + y * cols + x;
        float sum = half_kernel[0] * from[0];
        for (int i = 1; i <= margin; ++i) {
          sum += half_kernel[static_cast<std::size_t>(i)] * (from[-i * step] + from[i * step]);
        }
        values[static_cast<std::size_t>(y * cols + x)] = sum;
      }
    }
  }
}

/// Pixels of a square, those outside of the image from the nearest inside.
std::vector<float> cutOut(const cv::Mat& gray, const cv::Point& corner, int size) {
  std::vector<int> columns;
  for (int x = corner.x; x < corner.x + size; ++x) {
    columns.push_back(std::clamp(x, 0, gray.cols - 1));
  }
  std::vector<float> values;
  values.reserve(static_cast<std::size_t>(size) * static_cast<std::size_t>(size));
  for (int y = corner.y; y < corner.y + size; ++y) {
    const std::uint8_t* line = gray.ptr<std::uint8_t>(std::clamp(y, 0, gray.rows - 1));
    for (const int column : columns) {
      values.push_back(line[column]);
    }
  }
  return values;
}

}  // namespace

Patch::Patch(const cv::Mat& gray, const Eigen::Vector2d& centre, double reach_px, double blur_px)
    : half_blur_(halfGaussian(blur_px)), blur_correlation_(correlation(half_blur_)) {
  const int reach = static_cast<int>(std::ceil(reach_px)) + static_cast<int>(half_blur_.size()) + kSpare_px;
  const cv::Point corner(static_cast<int>(std::lround(centre.x())) - reach,
                         static_cast<int>(std::lround(centre.y())) - reach);
  cols_ = rows_ = 2 * reach + 1;
  spread_px2_ = kPixelSpread_px2 + kSplineSpread_px2 + blur_px * blur_px;
  origin_ = Eigen::Vector2f(static_cast<float>(corner.x), static_cast<float>(corner.y));
  values_ = cutOut(gray, corner, cols_);
  blur(half_blur_, cols_, values_);
}

bool Patch::holds(const Eigen::Vector2d& px, double reach_px) const {
  const Eigen::Vector2d local = px - origin_.cast<double>();
  return local.minCoeff() - reach_px >= 1.0 && local.maxCoeff() + reach_px < cols_ - kSpare_px;
}

double Patch::noiseGain(const Eigen::Vector2f& px) const {
  const Cell cell = cellOf(px);
  const auto along = [&](float fraction) {
    const Eigen::Vector4f weights = splineWeights(fraction).matrix();
    const bool is_blurred = half_blur_.size() > 1;
    return static_cast<double>(is_blurred ? weights.dot(blur_correlation_ * weights) : weights.squaredNorm());
  };
  return along(cell.fraction.x()) * along(cell.fraction.y());
}

Patch::PixelWeights::PixelWeights(const Patch& patch)
    : patch_(patch), first_(patch.values_.size(), 0.0F), second_(patch.values_.size(), 0.0F) {}

void Patch::PixelWeights::add(const Eigen::Vector2f& px, const Eigen::Vector2f& factor) {
  const Cell cell = patch_.cellOf(px);
  const Eigen::Array4f weight_x = splineWeights(cell.fraction.x());
  const Eigen::Array4f weight_y = splineWeights(cell.fraction.y());
  int index = cell.index;
  for (int i = 0; i < kTaps; ++i, index += patch_.cols_) {
    const Eigen::Array4f weights = weight_y[i] * weight_x;
    Eigen::Map<Eigen::Array4f>(first_.data() + index) += factor.x() * weights;
    Eigen::Map<Eigen::Array4f>(second_.data() + index) += factor.y() * weights;
  }
}

Eigen::Matrix2d Patch::PixelWeights::covariance() const {
  std::vector<float> first = first_;
  std::vector<float> second = second_;
  blur(patch_.half_blur_, patch_.cols_, first);  // symmetric, so it is its own transpose
  blur(patch_.half_blur_, patch_.cols_, second);
  const auto size = static_cast<Eigen::Index>(first.size());
  const Eigen::Map<const Eigen::VectorXf> a(first.data(), size);
  const Eigen::Map<const Eigen::VectorXf> b(second.data(), size);
  Eigen::Matrix2f covariance;
  covariance << a.squaredNorm(), a.dot(b), a.dot(b), b.squaredNorm();
  return covariance.cast<double>();
}

}  // namespace tartan_calib::detection
