#include "x_corner.h"

#include <algorithm>
#include <cmath>

#include "bilinear.h"
#include "correlation.h"

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

/// Where the border of the image cuts the pattern, so much of it must be left.
constexpr double kMinSeenShare = 0.5;
/// An uphill walk that ends on such a match has found the corner; a lesser hill need not be the highest.
constexpr double kCertainCorrelation = 0.9;
constexpr double kFineStep_px = 0.5;

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
      corner.offsets_px.emplace_back(*px - *centre);
      corner.pattern.push_back(-dark_diagonal * softSign(offset_m.x(), edge_x_m) * softSign(offset_m.y(), edge_y_m));
    }
  }
  return corner;
}

XCornerTemplate innerTemplate(const XCornerTemplate& corner) {
  constexpr int kSide = 2 * kSamplesPerQuadrantSide;
  constexpr int kFirst = kSamplesPerQuadrantSide / 2;
  XCornerTemplate inner;
  inner.px = corner.px;
  for (int row = kFirst; row < kSide - kFirst; ++row) {
    for (int col = kFirst; col < kSide - kFirst; ++col) {
      const auto i = static_cast<std::size_t>(row * kSide + col);
      inner.offsets_px.push_back(corner.offsets_px[i]);
      inner.pattern.push_back(corner.pattern[i]);
    }
  }
  return inner;
}

std::optional<XCornerMatch> matchXCorner(const cv::Mat& gray, const XCornerTemplate& corner, const Eigen::Vector2d& px) {
  Correlation values;
  for (std::size_t i = 0; i < corner.offsets_px.size(); ++i) {
    const Eigen::Vector2d at = px + corner.offsets_px[i];
    if (canSample(gray, at.x(), at.y())) {
      values.add(corner.pattern[i], sampleBilinear(gray, at.x(), at.y()));
    }
  }
  if (values.count() < kMinSeenShare * static_cast<double>(corner.offsets_px.size())) {
    return std::nullopt;
  }
  return XCornerMatch{px, values.value(), 2.0 * values.slope()};
}

std::optional<XCornerMatch> searchXCorner(const cv::Mat& gray, const XCornerTemplate& corner, double radius_px) {
  const auto in_radius = [&](const Eigen::Vector2d& px) { return (px - corner.px).norm() <= radius_px; };
  std::optional<XCornerMatch> best;
  const auto consider = [&](const Eigen::Vector2d& px) {
    const auto match = matchXCorner(gray, corner, px);
    if (match && (!best || match->correlation > best->correlation)) {
      best = match;
    }
  };
  const auto consider_around = [&](double step_px) {
    const Eigen::Vector2d centre = best ? best->px : corner.px;
    for (int dy = -1; dy <= 1; ++dy) {
      for (int dx = -1; dx <= 1; ++dx) {
        const Eigen::Vector2d px = centre + step_px * Eigen::Vector2d(dx, dy);
        if ((dx != 0 || dy != 0) && in_radius(px)) {
          consider(px);
        }
      }
    }
  };
  consider(corner.px);
  for (double before = -2.0; best && best->correlation > before;) {  // uphill
    before = best->correlation;
    consider_around(1.0);
  }
  if (!best || best->correlation < kCertainCorrelation) {
    const int reach = static_cast<int>(std::ceil(radius_px));
    for (int dy = -reach; dy <= reach; ++dy) {
      for (int dx = -reach; dx <= reach; ++dx) {
        const Eigen::Vector2d px = corner.px + Eigen::Vector2d(dx, dy);
        if (in_radius(px)) {
          consider(px);
        }
      }
    }
  }
  consider_around(kFineStep_px);
  return best;
}

}  // namespace tartan_calib::detection
