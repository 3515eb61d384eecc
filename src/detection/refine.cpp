#include "tartan_calib/detection/refine.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>
#include <vector>

namespace tartan_calib::detection {
namespace {

constexpr double kSampleSpacing_px = 0.8;
constexpr double kSmoothing = 0.5;         ///< sigma of the low-pass [scale]
constexpr double kBorderReserve_px = 1.2;  ///< for gradients, interpolation and the first steps
constexpr double kMaxReach = 4.0;          ///< of a sample, in largest half windows: more is no map of a board
constexpr double kConvergedStep_px = 1e-3;
constexpr double kAcceptedStep_px = 0.02;  ///< of the last iteration allowed
/// Linear change of light, relative, that is usual within a window; keeps the estimate still where the window is dark.
constexpr double kLightSlopeSigma_per_px = 0.01;
constexpr double kGraySigmaFloor = 0.5;     ///< quantisation and more [grey levels]
constexpr double kPositionFloor_px = 0.01;  ///< what sampling of the image costs, however clear the corner

/// Pixel offsets of a board point and of its mirror image in the corner.
struct SamplePair {
  Eigen::Vector2d plus_px;
  Eigen::Vector2d minus_px;
};

struct SampleSet {
  std::vector<SamplePair> pairs;
  double pairs_per_px2 = 1.0;
  double reach_px = 0.0;  ///< of the farthest sample
};

/// Half of the window in board units along one board axis, at most `max_px` and at least the smallest allowed.
double axisHalfWindow(const BoardToPixelOffset& map, const Eigen::Vector2d& axis, const RefineOptions& options,
                      double max_px) {
  const double length_px = 0.5 * (map(options.half_window * axis) - map(-options.half_window * axis)).norm();
  if (!(length_px > 0.0)) {
    return 0.0;
  }
  return options.half_window * std::clamp(length_px, options.scale_px * options.min_half_window_px, max_px) / length_px;
}

/// Nothing where the map does not spread the window over a part of the image.
std::optional<SampleSet> makeSamples(const BoardToPixelOffset& map, const RefineOptions& options,
                                     double max_half_window_px) {
  const Eigen::Vector2d axis_u =
      Eigen::Vector2d::UnitX() * axisHalfWindow(map, Eigen::Vector2d::UnitX(), options, max_half_window_px);
  const Eigen::Vector2d axis_v =
      Eigen::Vector2d::UnitY() * axisHalfWindow(map, Eigen::Vector2d::UnitY(), options, max_half_window_px);
  const Eigen::Vector2d u_px = map(axis_u);
  const Eigen::Vector2d v_px = map(axis_v);
  const double max_length_px = kMaxReach * max_half_window_px;
  if (!(u_px.norm() > 0.0 && v_px.norm() > 0.0 && u_px.norm() < max_length_px && v_px.norm() < max_length_px)) {
    return std::nullopt;
  }
  const double spacing_px = kSampleSpacing_px * options.scale_px;
  const int num_u = std::max(2, static_cast<int>(std::ceil(u_px.norm() / spacing_px)));
  const int num_v = std::max(2, static_cast<int>(std::ceil(v_px.norm() / spacing_px)));
  SampleSet set;
  for (int j = 0; j <= num_v; ++j) {
    for (int i = j == 0 ? 1 : -num_u; i <= num_u; ++i) {
      const Eigen::Vector2d s = axis_u * i / num_u + axis_v * j / num_v;
      set.pairs.push_back({map(s), map(-s)});
      set.reach_px = std::max({set.reach_px, set.pairs.back().plus_px.norm(), set.pairs.back().minus_px.norm()});
    }
  }
  const double cell_px2 = std::abs(u_px.x() * v_px.y() - u_px.y() * v_px.x()) / (num_u * num_v);
  set.pairs_per_px2 = 1.0 / std::max(cell_px2, 1e-3);
  return set;
}

/// Grey value and gradient around a corner, for bilinear sampling.
class Patch {
 public:
  struct Value {
    double gray;
    Eigen::Vector2d gradient_per_px;
  };

  /// Square of half-size `reach_px` around `centre`, as far as the image goes; low-passed where detail is coarser than
  /// pixels.
  Patch(const cv::Mat& image, const Eigen::Vector2d& centre, double reach_px, double scale_px) {
    const int reach = static_cast<int>(std::ceil(reach_px)) + 2;  // one for the gradient, one for interpolation
    const cv::Rect box = cv::Rect(static_cast<int>(std::lround(centre.x())) - reach,
                                  static_cast<int>(std::lround(centre.y())) - reach, 2 * reach + 1, 2 * reach + 1) &
                         cv::Rect({0, 0}, image.size());
    origin_ = Eigen::Vector2d(box.x, box.y);
    cv::Mat1f gray;
    image(box).convertTo(gray, CV_32F);
    if (scale_px > 1.0) {
      cv::GaussianBlur(gray, gray, {}, kSmoothing * scale_px);
    }
    values_.create(box.size());
    for (int y = 1; y + 1 < gray.rows; ++y) {
      for (int x = 1; x + 1 < gray.cols; ++x) {
        values_(y, x) = {gray(y, x), 0.5F * (gray(y, x + 1) - gray(y, x - 1)), 0.5F * (gray(y + 1, x) - gray(y - 1, x))};
      }
    }
  }

  /// True if `at` is possible for all points within `reach_px` along each axis.
  bool holds(const Eigen::Vector2d& px, double reach_px) const {
    const Eigen::Vector2d local = px - origin_;
    return local.x() - reach_px >= 1.0 && local.y() - reach_px >= 1.0 && local.x() + reach_px < values_.cols - 2 &&
           local.y() + reach_px < values_.rows - 2;
  }

  Value at(const Eigen::Vector2d& px) const {
    const Eigen::Vector2d local = px - origin_;
    const int x = static_cast<int>(local.x());
    const int y = static_cast<int>(local.y());
    const auto fx = static_cast<float>(local.x() - x);
    const auto fy = static_cast<float>(local.y() - y);
    const cv::Vec3f* top = values_[y] + x;
    const cv::Vec3f* bottom = values_[y + 1] + x;
    const cv::Vec3f v = (1.0F - fy) * ((1.0F - fx) * top[0] + fx * top[1]) + fy * ((1.0F - fx) * bottom[0] + fx * bottom[1]);
    return {v[0], Eigen::Vector2d(v[1], v[2])};
  }

 private:
  Eigen::Vector2d origin_ = Eigen::Vector2d::Zero();
  cv::Mat_<cv::Vec3f> values_;
};

/// Gauss-Newton on the centre (2) and the relative slope of light (2).
struct NormalEquations {
  Eigen::Matrix4d matrix = Eigen::Matrix4d::Zero();
  Eigen::Vector4d right = Eigen::Vector4d::Zero();
  double squared_residuals = 0.0;
  int num_pairs = 0;
};

NormalEquations linearize(const Patch& patch, const SampleSet& samples, const Eigen::Vector2d& centre) {
  NormalEquations normal;
  for (const SamplePair& pair : samples.pairs) {
    const Patch::Value plus = patch.at(centre + pair.plus_px);
    const Patch::Value minus = patch.at(centre + pair.minus_px);
    const double residual = plus.gray - minus.gray;
    Eigen::Vector4d row;
    row << plus.gradient_per_px - minus.gradient_per_px, -0.5 * (plus.gray + minus.gray) * (pair.plus_px - pair.minus_px);
    normal.matrix += row * row.transpose();
    normal.right -= residual * row;
    normal.squared_residuals += residual * residual;
    ++normal.num_pairs;
  }
  const double prior = std::pow(kGraySigmaFloor / kLightSlopeSigma_per_px, 2.0);
  normal.matrix(2, 2) += prior;
  normal.matrix(3, 3) += prior;
  return normal;
}

/// Difference of the mean grey values above and below the middle of a window.
double windowContrast(const Patch& patch, const SampleSet& samples, const Eigen::Vector2d& centre) {
  std::vector<double> gray;
  double mean = 0.0;
  for (const SamplePair& pair : samples.pairs) {
    for (const Eigen::Vector2d& offset : {pair.plus_px, pair.minus_px}) {
      gray.push_back(patch.at(centre + offset).gray);
      mean += gray.back();
    }
  }
  mean /= static_cast<double>(gray.size());
  double deviation = 0.0;
  for (const double value : gray) {
    deviation += std::abs(value - mean);
  }
  return 2.0 * deviation / static_cast<double>(gray.size());
}

/// The result at the last linearisation; nothing where the window is empty or not symmetric.
std::optional<RefinedCorner> conclude(const NormalEquations& normal, const SampleSet& samples, double contrast,
                                      const RefineOptions& options) {
  const Eigen::Vector4d solution = normal.matrix.ldlt().solve(normal.right);
  const double left = std::max(0.0, normal.squared_residuals - solution.dot(normal.right));
  const double variance = left / std::max(1, normal.num_pairs - 4);
  RefinedCorner corner;
  corner.residual_ratio = std::sqrt(variance) / std::max(contrast, 1e-6);
  if (contrast < options.min_contrast || corner.residual_ratio > options.max_residual_ratio) {
    return std::nullopt;
  }
  // Samples denser than pixels repeat the same noise; a residual is a difference of two grey values.
  const double repeats = std::max(1.0, 2.0 * samples.pairs_per_px2);
  const double floor = 2.0 * kGraySigmaFloor * kGraySigmaFloor;
  const Eigen::Matrix4d inverse = normal.matrix.inverse();
  corner.cov_px2 = repeats * std::max(variance, floor) * inverse.topLeftCorner<2, 2>() +
                   kPositionFloor_px * kPositionFloor_px * Eigen::Matrix2d::Identity();
  return corner.cov_px2.allFinite() ? std::optional<RefinedCorner>(corner) : std::nullopt;
}

}  // namespace

std::optional<RefinedCorner> refineBySymmetry(const cv::Mat& gray, const Eigen::Vector2d& start_px,
                                              const BoardToPixelOffset& map, const RefineOptions& options) {
  const double to_border_px =
      std::min(start_px.minCoeff(), std::min(gray.cols - 1 - start_px.x(), gray.rows - 1 - start_px.y()));
  const double max_reach_px = to_border_px - kBorderReserve_px;
  const double max_half_window_px = options.scale_px * options.max_half_window_px;
  auto window = makeSamples(map, options, max_half_window_px);
  if (window && window->reach_px > max_reach_px) {
    window =
        makeSamples(map, options, std::max(options.scale_px * options.min_half_window_px, max_reach_px / std::sqrt(2.0)));
  }
  if (!window || !(window->reach_px <= std::min(max_reach_px, kMaxReach * max_half_window_px))) {
    return std::nullopt;
  }
  const SampleSet& samples = *window;
  const Patch patch(gray, start_px, samples.reach_px + options.max_shift_px, options.scale_px);
  Eigen::Vector2d centre = start_px;
  NormalEquations normal;
  double step_px = std::numeric_limits<double>::max();
  for (int iteration = 0; iteration < options.max_iterations && step_px > kConvergedStep_px; ++iteration) {
    if (!patch.holds(centre, samples.reach_px)) {
      return std::nullopt;
    }
    normal = linearize(patch, samples, centre);
    const Eigen::Vector2d step = normal.matrix.ldlt().solve(normal.right).head<2>();
    step_px = step.norm();
    centre += step;
    if (!centre.allFinite() || (centre - start_px).norm() > options.max_shift_px) {
      return std::nullopt;
    }
  }
  if (step_px > kAcceptedStep_px || !patch.holds(centre, samples.reach_px)) {
    return std::nullopt;
  }
  auto corner = conclude(normal, samples, windowContrast(patch, samples, centre), options);
  if (corner) {
    corner->px = centre;
  }
  return corner;
}

}  // namespace tartan_calib::detection
