#include "tartan_calib/detection/window_refine.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>

#include "window_covariance.h"

namespace tartan_calib::detection {
namespace {

constexpr int kLeastHalfWindow_px = 1;

/// Pixels between a point and the border of the image, less one for the gradient.
int roomInImage_px(const cv::Mat& gray, const Eigen::Vector2d& px) {
  const double to_border_px = std::min(px.minCoeff(), std::min(gray.cols - 1 - px.x(), gray.rows - 1 - px.y()));
  return static_cast<int>(std::floor(to_border_px)) - 1;
}

/// What a covariance becomes with the knowledge that the corner is about `radius_px` around where it was looked for.
Eigen::Matrix2d within(double radius_px, const Eigen::Matrix2d& cov_px2) {
  const double radius_px2 = radius_px * radius_px;
  return radius_px2 * cov_px2 * (cov_px2 + radius_px2 * Eigen::Matrix2d::Identity()).inverse();
}

/// Positions of lattice lines, and of one more at each end, as far away as the second gap: a tag grid's gaps alternate.
std::vector<double> withOuterLines(const std::vector<double>& lines_m) {
  const std::size_t count = lines_m.size();
  const bool alternates = count > 2;
  const double first_gap_m = alternates ? lines_m[2] - lines_m[1] : lines_m.back() - lines_m.front();
  const double last_gap_m = alternates ? lines_m[count - 2] - lines_m[count - 3] : first_gap_m;
  std::vector<double> extended = {lines_m.front() - first_gap_m};
  extended.insert(extended.end(), lines_m.begin(), lines_m.end());
  extended.push_back(lines_m.back() + last_gap_m);
  return extended;
}

}  // namespace

std::optional<RefinedCorner> refineInWindow(const cv::Mat& gray, const Eigen::Vector2d& start_px,
                                            const WindowRefineOptions& options) {
  const int half_window_px = std::min(options.half_window_px, roomInImage_px(gray, start_px));
  if (half_window_px < kLeastHalfWindow_px) {
    return std::nullopt;
  }
  std::vector<cv::Point2f> points = {cv::Point2f(static_cast<float>(start_px.x()), static_cast<float>(start_px.y()))};
  const cv::TermCriteria criteria(cv::TermCriteria::COUNT + cv::TermCriteria::EPS, options.max_iterations,
                                  options.min_step_px);
  cv::cornerSubPix(gray, points, {half_window_px, half_window_px}, {-1, -1}, criteria);
  RefinedCorner corner;
  corner.px = Eigen::Vector2d(static_cast<double>(points[0].x), static_cast<double>(points[0].y));
  corner.cov_px2 = within(options.max_shift_px, windowCovariance(gray, corner.px, half_window_px));
  const bool is_near = (corner.px - start_px).norm() <= options.max_shift_px;
  return is_near && corner.cov_px2.allFinite() ? std::make_optional(corner) : std::nullopt;
}

CornerNeighbours::CornerNeighbours(const target::Target& target)
    : lattice_(target::cornerLattice(target)), x_along_rows_(std::holds_alternative<target::Checkerboard>(target)) {
  const std::vector<Eigen::Vector3d> points = target::cornerPoints(target);
  std::vector<double> across_m;
  std::vector<double> along_m;
  for (int col = 0; col < lattice_.cols; ++col) {
    across_m.push_back(points[static_cast<std::size_t>(col)][x_along_rows_ ? 1 : 0]);
  }
  for (int row = 0; row < lattice_.rows; ++row) {
    along_m.push_back(points[static_cast<std::size_t>(row * lattice_.cols)][x_along_rows_ ? 0 : 1]);
  }
  col_m_ = withOuterLines(across_m);
  row_m_ = withOuterLines(along_m);
}

double CornerNeighbours::nearest_px(const BoardMap& map, int corner_id) const {
  const auto at = [&](int row, int col) {
    const double across_m = col_m_[static_cast<std::size_t>(col + 1)];
    const double along_m = row_m_[static_cast<std::size_t>(row + 1)];
    return map(x_along_rows_ ? Eigen::Vector2d(along_m, across_m) : Eigen::Vector2d(across_m, along_m));
  };
  const int row = corner_id / lattice_.cols;
  const int col = corner_id % lattice_.cols;
  const auto centre = at(row, col);
  double nearest_px = std::numeric_limits<double>::infinity();
  for (const auto& [dr, dc] : {std::pair(0, 1), std::pair(0, -1), std::pair(1, 0), std::pair(-1, 0)}) {
    const auto neighbour = at(row + dr, col + dc);
    if (centre && neighbour) {
      nearest_px = std::min(nearest_px, (*neighbour - *centre).norm());
    }
  }
  return nearest_px;
}

int adaptiveHalfWindow(double nearest_px, const AdaptiveWindowOptions& options) {
  const double wanted_px = std::min(options.scale * nearest_px, static_cast<double>(options.max_half_window_px));
  return std::max(options.min_half_window_px, static_cast<int>(wanted_px));
}

}  // namespace tartan_calib::detection
