#include "tartan_calib/guidance/blur.h"

#include <algorithm>
#include <cmath>
#include <variant>

#include "tartan_calib/median.h"

namespace tartan_calib::guidance {
namespace {

/// Length of a profile to each side of an edge, as a share of the edge: within the border of a tag of 2 of 10 cells.
constexpr double kReach_ratio = 0.18;
constexpr double kMinReach_px = 3.0;
constexpr double kMaxReach_px = 16.0;
constexpr double kMinEdge_px = 12.0;  ///< shorter ones are blurred into each other
constexpr double kMinContrast = 30;   ///< [grey levels] below it, paper without an edge
constexpr std::size_t kMinEdges = 3;
constexpr double kStep_px = 0.5;

double bilinear(const cv::Mat& gray, const Eigen::Vector2d& px) {
  const int x = static_cast<int>(std::floor(px.x()));
  const int y = static_cast<int>(std::floor(px.y()));
  const double ax = px.x() - x;
  const double ay = px.y() - y;
  const auto* upper = gray.ptr<unsigned char>(y);
  const auto* lower = gray.ptr<unsigned char>(y + 1);
  return (1.0 - ay) * ((1.0 - ax) * upper[x] + ax * upper[x + 1]) + ay * ((1.0 - ax) * lower[x] + ax * lower[x + 1]);
}

bool isInside(const cv::Mat& gray, const Eigen::Vector2d& px) {
  return px.x() >= 0.0 && px.y() >= 0.0 && px.x() < gray.cols - 1.0 && px.y() < gray.rows - 1.0;
}

/// Of the edge between two corners, across its middle: contrast over steepest slope. Empty where there is no edge.
std::optional<double> blurAcross(const cv::Mat& gray, const Eigen::Vector2d& from_px, const Eigen::Vector2d& to_px) {
  const double length_px = (to_px - from_px).norm();
  if (length_px < kMinEdge_px) {
    return std::nullopt;
  }
  const Eigen::Vector2d along = (to_px - from_px) / length_px;
  const Eigen::Vector2d normal(-along.y(), along.x());
  const double reach_px = std::clamp(kReach_ratio * length_px, kMinReach_px, kMaxReach_px);
  const Eigen::Vector2d middle_px = 0.5 * (from_px + to_px);
  if (!isInside(gray, middle_px - (reach_px + 1.0) * normal) || !isInside(gray, middle_px + (reach_px + 1.0) * normal)) {
    return std::nullopt;
  }
  double lowest = 255.0;
  double highest = 0.0;
  double steepest = 0.0;  // over one pixel
  for (double at_px = -reach_px; at_px <= reach_px; at_px += kStep_px) {
    const double before = bilinear(gray, middle_px + (at_px - 0.5) * normal);
    const double after = bilinear(gray, middle_px + (at_px + 0.5) * normal);
    steepest = std::max(steepest, std::abs(after - before));
    lowest = std::min({lowest, before, after});
    highest = std::max({highest, before, after});
  }
  if (highest - lowest < kMinContrast) {
    return std::nullopt;
  }
  return (highest - lowest) / (steepest * std::sqrt(2.0 * M_PI));  // the slope in the middle of a Gaussian-blurred step
}

std::optional<double> medianOf(std::vector<double> values) {
  if (values.size() < kMinEdges) {
    return std::nullopt;
  }
  return upperMedian(values);
}

/// Median over the edges between corners whose ids differ by `stride`.
std::optional<double> blurOf(const cv::Mat& gray, const std::vector<const observation::Corner*>& by_id, int stride,
                             int cols) {
  std::vector<double> blurs_px;
  for (std::size_t id = 0; id + static_cast<std::size_t>(stride) < by_id.size(); ++id) {
    const observation::Corner* next = by_id[id + static_cast<std::size_t>(stride)];
    const bool wraps = stride == 1 && static_cast<int>(id) % cols == cols - 1;
    if (by_id[id] == nullptr || next == nullptr || wraps) {
      continue;
    }
    if (const auto blur_px = blurAcross(gray, by_id[id]->px, next->px)) {
      blurs_px.push_back(*blur_px);
    }
  }
  return medianOf(blurs_px);
}

}  // namespace

std::optional<double> edgeBlur(const cv::Mat& gray, const std::vector<observation::Corner>& corners,
                               const target::Target& target) {
  if (std::holds_alternative<target::CircleGrid>(target)) {
    return std::nullopt;
  }
  const target::Lattice lattice = target::cornerLattice(target);
  std::vector<const observation::Corner*> by_id(static_cast<std::size_t>(lattice.rows * lattice.cols), nullptr);
  for (const observation::Corner& corner : corners) {
    by_id.at(static_cast<std::size_t>(corner.corner_id)) = &corner;
  }
  const auto along_rows = blurOf(gray, by_id, 1, lattice.cols);
  const auto along_cols = blurOf(gray, by_id, lattice.cols, lattice.cols);
  return along_rows && along_cols ? std::max(along_rows, along_cols) : along_rows ? along_rows : along_cols;
}

}  // namespace tartan_calib::guidance
