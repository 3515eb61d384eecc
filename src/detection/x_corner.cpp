#include "x_corner.h"

#include <algorithm>
#include <cmath>

#include "bilinear.h"

namespace tartan_calib::detection {
namespace {

constexpr int kSamplesPerQuadrantSide = 4;
/// The image of an edge is about this wide: the pattern rises over it instead of jumping.
constexpr double kEdgeWidth_px = 1.0;

/// Length [px] of the image of `step_m` from the corner.
std::optional<double> imageLength(const BoardMap& map, const Eigen::Vector2d& corner_m, const Eigen::Vector2d& step_m) {
  const auto from = map(corner_m - step_m);
  const auto to = map(corner_m + step_m);
  if (!from || !to) {
    return std::nullopt;
  }
  return 0.5 * (*to - *from).norm();
}

double softSign(double value, double width) { return std::clamp(value / width, -1.0, 1.0); }

}  // namespace

std::optional<XCornerTemplate> xCornerTemplate(const BoardMap& map, const Eigen::Vector2d& corner_m, double half_width_m,
                                               int dark_diagonal) {
  const auto centre = map(corner_m);
  const auto length_x = imageLength(map, corner_m, {half_width_m, 0.0});
  const auto length_y = imageLength(map, corner_m, {0.0, half_width_m});
  if (!centre || !length_x || !length_y) {
    return std::nullopt;
  }
  XCornerTemplate corner;
  corner.px = *centre;
  const double edge_x_m = half_width_m * kEdgeWidth_px / std::max(*length_x, kEdgeWidth_px);
  const double edge_y_m = half_width_m * kEdgeWidth_px / std::max(*length_y, kEdgeWidth_px);
  const double step_m = half_width_m / kSamplesPerQuadrantSide;
  for (int row = -kSamplesPerQuadrantSide; row < kSamplesPerQuadrantSide; ++row) {
    for (int col = -kSamplesPerQuadrantSide; col < kSamplesPerQuadrantSide; ++col) {
      const Eigen::Vector2d offset_m((col + 0.5) * step_m, (row + 0.5) * step_m);
      const auto px = map(corner_m + offset_m);
      if (!px) {
        return std::nullopt;
      }
      corner.offsets_px.push_back(*px - *centre);
      corner.pattern.push_back(-dark_diagonal * softSign(offset_m.x(), edge_x_m) * softSign(offset_m.y(), edge_y_m));
    }
  }
  return corner;
}

std::optional<XCornerMatch> matchXCorner(const cv::Mat& gray, const XCornerTemplate& corner, const Eigen::Vector2d& px) {
  double sum = 0.0;
  double sum_squares = 0.0;
  double cross = 0.0;
  double pattern_squares = 0.0;
  for (std::size_t i = 0; i < corner.offsets_px.size(); ++i) {
    const Eigen::Vector2d at = px + corner.offsets_px[i];
    if (!canSample(gray, at.x(), at.y())) {
      return std::nullopt;
    }
    const double value = sampleBilinear<std::uint8_t>(gray, at.x(), at.y());
    sum += value;
    sum_squares += value * value;
    cross += corner.pattern[i] * value;  // the pattern's mean is 0, so the grey values' mean drops out
    pattern_squares += corner.pattern[i] * corner.pattern[i];
  }
  const double variation = sum_squares - sum * sum / static_cast<double>(corner.offsets_px.size());
  XCornerMatch match;
  match.px = px;
  match.contrast = 2.0 * cross / pattern_squares;
  match.correlation = variation > 0.0 ? cross / std::sqrt(variation * pattern_squares) : 0.0;
  return match;
}

std::optional<XCornerMatch> searchXCorner(const cv::Mat& gray, const XCornerTemplate& corner, double radius_px) {
  std::optional<XCornerMatch> best;
  const auto consider = [&](const Eigen::Vector2d& px) {
    const auto match = matchXCorner(gray, corner, px);
    if (match && (!best || match->correlation > best->correlation)) {
      best = match;
    }
  };
  const int reach = static_cast<int>(std::ceil(radius_px));
  for (int dy = -reach; dy <= reach; ++dy) {
    for (int dx = -reach; dx <= reach; ++dx) {
      if (Eigen::Vector2d(dx, dy).norm() <= radius_px) {
        consider(corner.px + Eigen::Vector2d(dx, dy));
      }
    }
  }
  if (!best) {
    return best;
  }
  const Eigen::Vector2d coarse = best->px;
  for (int dy = -1; dy <= 1; ++dy) {
    for (int dx = -1; dx <= 1; ++dx) {
      consider(coarse + 0.5 * Eigen::Vector2d(dx, dy));
    }
  }
  return best;
}

}  // namespace tartan_calib::detection
