#include "tartan_calib/detection/refine.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "light_slope.h"
#include "patch.h"
#include "symmetric_window.h"

namespace tartan_calib::detection {
namespace {

/// Smaller windows that are tried, as shares of the asked one, where that one is not symmetric.
constexpr std::array<double, 3> kSmallerWindows = {0.67, 0.45, 0.3};
/// Asymmetry in units of the contrast up to which nothing but noise is suspected.
constexpr double kFineResidual_ratio = 0.04;
/// How much more noise than in a smaller window, as variance, is still the same: a share, and what estimates scatter.
constexpr double kSameNoise_ratio = 1.2;
constexpr double kNoiseScatterSigmas = 3.0;
constexpr double kBlur = 0.5;  ///< sigma of the low-pass where detail is coarser than pixels [scale]
constexpr double kConvergedStep_px = 2e-3;
constexpr double kAcceptedStep_px = 0.02;  ///< of the last iteration allowed
constexpr double kFineStep_px = 0.05;      ///< longer steps look at a part of the samples only
constexpr std::size_t kCoarseStride = 4;
constexpr std::size_t kManyPairs = 64;
constexpr double kReselectStep_px = 0.3;          ///< after such a move other samples lie inside of the image
constexpr double kRoundingVariance = 1.0 / 12.0;  ///< [grey levels^2]: pixels are integers
constexpr int kNumUnknowns = 4;
constexpr std::size_t kMinPairs = 8;  // twice the unknowns

/// Gauss-Newton on the centre (2) and the relative slope of light (2).
struct NormalEquations {
  Eigen::Matrix4f matrix = Eigen::Matrix4f::Zero();
  Eigen::Vector4f right = Eigen::Vector4f::Zero();
  double squared_residuals = 0.0;
  Eigen::Vector4d solution = Eigen::Vector4d::Zero();
};

/// Of the residual gray(plus) - gray(minus).
Eigen::Vector4f jacobian(const Patch::Sample& plus, const Patch::Sample& minus, const SamplePair& pair) {
  const float mean = 0.5F * (plus.gray + minus.gray);
  const Eigen::Vector2f across_px = pair.plus_px - pair.minus_px;
  return {plus.slope_x - minus.slope_x, plus.slope_y - minus.slope_y, -mean * across_px.x(), -mean * across_px.y()};
}

/// What the image shows at the two points of every pair that a linearisation looked at.
using PairValues = std::vector<std::array<Patch::Sample, 2>>;

/// From every pair, or every `stride`-th one. Fills `values`.
NormalEquations linearize(const Patch& patch, const SampleSet& samples, const Eigen::Vector2d& centre_px, std::size_t stride,
                          PairValues& values) {
  NormalEquations normal;
  values.clear();
  const Eigen::Vector2f centre = centre_px.cast<float>();
  float squared_residuals = 0.0F;
  for (std::size_t k = 0; k < samples.pairs.size(); k += stride) {
    const SamplePair& pair = samples.pairs[k];
    const Patch::Sample plus = patch.at(centre + pair.plus_px);
    const Patch::Sample minus = patch.at(centre + pair.minus_px);
    values.push_back({plus, minus});
    const float residual = plus.gray - minus.gray;
    const Eigen::Vector4f row = jacobian(plus, minus, pair);
    for (int i = 0; i < kNumUnknowns; ++i) {
      normal.matrix.col(i) += row[i] * row;
    }
    normal.right -= residual * row;
    squared_residuals += residual * residual;
  }
  normal.squared_residuals = static_cast<double>(squared_residuals);
  normal.matrix.diagonal().tail<2>().array() += static_cast<float>(kLightSlopePrior);
  normal.solution = normal.matrix.cast<double>().ldlt().solve(normal.right.cast<double>());
  return normal;
}

/// Difference of the mean grey values above and below the middle of a window.
double windowContrast(const PairValues& values) {
  const auto count = static_cast<float>(2 * values.size());
  float sum = 0.0F;
  for (const auto& [plus, minus] : values) {
    sum += plus.gray + minus.gray;
  }
  const float mean = sum / count;
  float deviation = 0.0F;
  for (const auto& [plus, minus] : values) {
    deviation += std::abs(plus.gray - mean) + std::abs(minus.gray - mean);
  }
  return static_cast<double>(2.0F * deviation / count);
}

/// A refined corner and the noise of the pixels as its window shows it.
struct Attempt {
  RefinedCorner corner;
  double variance = 0.0;  ///< of a pixel [grey levels^2]
  double freedom = 1.0;   ///< number of residuals behind the variance, less the unknowns
  double contrast = 0.0;  ///< [grey levels]
};

/// The result of the last linearisation, whose last step is too short to change `values`. The centre is a linear function of
/// the residuals, these of the samples, and these of the pixels; the noise of the pixels, as the residuals show it, is
/// carried through all three.
Attempt conclude(const Patch& patch, const SampleSet& samples, const NormalEquations& normal, const PairValues& values,
                 const Eigen::Vector2d& centre_px) {
  const Eigen::Vector2f centre = centre_px.cast<float>();
  const Eigen::Matrix4d inverse = normal.matrix.cast<double>().inverse();
  // Light that rises by s moves what a blur of variance v shows of the board by -v s, for the brighter side counts more.
  Eigen::Matrix<double, 2, 4> from_unknowns;
  from_unknowns << Eigen::Matrix2d::Identity(), patch.spread_px2() * Eigen::Matrix2d::Identity();
  const Eigen::Matrix<float, 2, 4> gain = (from_unknowns * inverse).cast<float>();
  Patch::PixelWeights weights(patch);
  double residual_gain = 0.0;  // of the sum of squared residuals, where the variance of a pixel is 1
  for (std::size_t k = 0; k < samples.pairs.size(); ++k) {
    const SamplePair& pair = samples.pairs[k];
    const Eigen::Vector2f plus_px = centre + pair.plus_px;
    const Eigen::Vector2f minus_px = centre + pair.minus_px;
    const Eigen::Vector2f factor = gain * jacobian(values[k][0], values[k][1], pair);
    weights.add(plus_px, factor);
    weights.add(minus_px, -factor);
    residual_gain += patch.noiseGain(plus_px) + patch.noiseGain(minus_px);
  }
  const auto num_pairs = static_cast<double>(samples.pairs.size());
  const double independent = std::max<double>(kMinPairs, num_pairs / std::max(1.0, samples.pairs_per_px2));
  const double left = std::max(0.0, normal.squared_residuals - normal.solution.dot(normal.right.cast<double>()));
  Attempt attempt;
  attempt.freedom = independent - kNumUnknowns;
  attempt.variance = std::max(kRoundingVariance, left / residual_gain * independent / attempt.freedom);
  attempt.corner.px = centre_px + from_unknowns.rightCols<2>() * normal.solution.tail<2>();
  attempt.corner.cov_px2 = attempt.variance * weights.covariance();
  attempt.contrast = windowContrast(values);
  attempt.corner.residual_ratio = std::sqrt(left / num_pairs) / std::max(attempt.contrast, 1e-6);
  return attempt;
}

class SymmetryRefinement {
 public:
  /// Keeps references.
  SymmetryRefinement(const cv::Mat& gray, const Eigen::Vector2d& start_px, const SymmetricWindow& window,
                     const RefineOptions& options)
      : gray_(gray), start_px_(start_px), window_(window), options_(options) {}

  std::optional<RefinedCorner> run() const {
    std::vector<Attempt> attempts;
    for (std::size_t i = 0; i <= kSmallerWindows.size(); ++i) {
      const auto attempt = refineIn(i == 0 ? 1.0 : kSmallerWindows.at(i - 1));
      if (!attempt) {
        continue;
      }
      attempts.push_back(*attempt);
      if (!options_.may_shrink || (i == 0 && attempt->corner.residual_ratio <= kFineResidual_ratio)) {
        break;
      }
    }
    return choose(attempts);
  }

 private:
  std::optional<Attempt> refineIn(double share) const {
    Eigen::Vector2d centre_px = start_px_;
    SampleSet samples = window_.samples(share, centre_px, gray_.size());
    Eigen::Vector2d selected_px = centre_px;
    const double blur_px = options_.scale_px > 1.0 ? kBlur * options_.scale_px : 0.0;
    const Patch patch(gray_, start_px_, samples.reach_px + options_.max_shift_px, blur_px);
    NormalEquations normal;
    PairValues values;
    double step_px = std::numeric_limits<double>::max();
    bool is_coarse = samples.pairs.size() >= kManyPairs;
    for (int i = 0; i < options_.max_iterations && step_px > kConvergedStep_px; ++i) {
      if (samples.pairs.size() < kMinPairs || !patch.holds(centre_px, samples.reach_px)) {
        return std::nullopt;
      }
      normal = linearize(patch, samples, centre_px, is_coarse ? kCoarseStride : 1, values);
      const Eigen::Vector2d step = normal.solution.head<2>();
      const bool was_coarse = is_coarse;
      is_coarse = is_coarse && step.norm() > kFineStep_px;
      step_px = was_coarse ? std::numeric_limits<double>::max() : step.norm();
      centre_px += step;
      if (!centre_px.allFinite() || (centre_px - start_px_).norm() > options_.max_shift_px) {
        return std::nullopt;
      }
      if ((centre_px - selected_px).norm() > kReselectStep_px) {
        samples = window_.samples(share, centre_px, gray_.size());
        selected_px = centre_px;
        step_px = std::numeric_limits<double>::max();
      }
    }
    const bool has_settled = step_px <= kAcceptedStep_px && patch.holds(centre_px, samples.reach_px);
    return has_settled ? std::make_optional(conclude(patch, samples, normal, values, centre_px)) : std::nullopt;
  }

  /// The largest window whose noise is that of all smaller ones, as far as it can be told.
  std::optional<RefinedCorner> choose(const std::vector<Attempt>& attempts) const {
    for (std::size_t i = 0; i < attempts.size(); ++i) {
      const auto explains = [&](const Attempt& smaller) {
        const double scatter = kNoiseScatterSigmas * std::sqrt(2.0 / smaller.freedom);
        return attempts[i].variance <= kSameNoise_ratio * (1.0 + scatter) * smaller.variance;
      };
      if (std::all_of(attempts.begin() + static_cast<std::ptrdiff_t>(i) + 1, attempts.end(), explains)) {
        return isAcceptable(attempts[i]) ? std::make_optional(attempts[i].corner) : std::nullopt;
      }
    }
    return std::nullopt;
  }

  bool isAcceptable(const Attempt& attempt) const {
    return attempt.contrast >= options_.min_contrast && attempt.corner.residual_ratio <= options_.max_residual_ratio &&
           attempt.corner.cov_px2.allFinite();
  }

  const cv::Mat& gray_;
  const Eigen::Vector2d& start_px_;
  const SymmetricWindow& window_;
  const RefineOptions& options_;
};

}  // namespace

std::optional<RefinedCorner> refineBySymmetry(const cv::Mat& gray, const Eigen::Vector2d& start_px,
                                              const BoardToPixelOffset& map, const RefineOptions& options) {
  const bool is_inside =
      start_px.x() >= 0.0 && start_px.y() >= 0.0 && start_px.x() <= gray.cols - 1 && start_px.y() <= gray.rows - 1;
  const auto window = is_inside ? SymmetricWindow::make(map, options) : std::nullopt;
  return window ? SymmetryRefinement(gray, start_px, *window, options).run() : std::nullopt;
}

}  // namespace tartan_calib::detection
