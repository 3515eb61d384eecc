#include "tartan_calib/simulation/coverage.h"

#include <algorithm>
#include <cmath>

namespace tartan_calib::simulation {
namespace {

Eigen::Vector2d pointAtX(const Eigen::Vector2d& from, const Eigen::Vector2d& to, double x) {
  return {x, from.y() + (to.y() - from.y()) * (x - from.x()) / (to.x() - from.x())};
}

}  // namespace

CoverageBuffer::CoverageBuffer(const cv::Rect& window)
    : origin_(window.x - 0.5, window.y - 0.5), column_change_(window.height, window.width + 1, 0.0F) {}

void CoverageBuffer::addEdge(const Eigen::Vector2d& from_px, const Eigen::Vector2d& to_px, double weight) {
  const Eigen::Vector2d origin(origin_.x, origin_.y);
  Eigen::Vector2d left = from_px - origin;
  Eigen::Vector2d right = to_px - origin;
  if (left.x() > right.x()) {
    left.swap(right);
    weight = -weight;
  }
  const double width = column_change_.cols - 1;
  if (left.x() >= width) {
    return;
  }
  if (right.x() > width) {
    right = pointAtX(left, right, width);
  }
  if (right.x() <= 0.0) {
    addInsideColumns({0.0, left.y()}, {0.0, right.y()}, weight);
    return;
  }
  if (left.x() < 0.0) {
    const Eigen::Vector2d entry = pointAtX(left, right, 0.0);
    addInsideColumns({0.0, left.y()}, entry, weight);
    left = entry;
  }
  addInsideColumns(left, right, weight);
}

void CoverageBuffer::addInsideColumns(const Eigen::Vector2d& from, const Eigen::Vector2d& to, double weight) {
  const double top = std::max(0.0, std::min(from.y(), to.y()));
  const double bottom = std::min(static_cast<double>(column_change_.rows), std::max(from.y(), to.y()));
  if (!(bottom > top)) {
    return;
  }
  const double sign = to.y() > from.y() ? weight : -weight;
  const double slope = (to.x() - from.x()) / (to.y() - from.y());
  const double x_min = std::min(from.x(), to.x());
  const double x_max = std::max(from.x(), to.x());
  const auto x_at = [&](double y) { return std::clamp(from.x() + slope * (y - from.y()), x_min, x_max); };
  double y = top;
  for (int row = static_cast<int>(top); y < bottom; ++row) {
    const double y_end = std::min(bottom, row + 1.0);
    addRowPiece(row, x_at(y), x_at(y_end), sign * (y_end - y));
    y = y_end;
  }
}

void CoverageBuffer::addRowPiece(int row, double x_from, double x_to, double signed_height) {
  const double x_min = std::min(x_from, x_to);
  const double x_max = std::max(x_from, x_to);
  float* const change = column_change_[row];
  const int last = std::min(static_cast<int>(x_max), column_change_.cols - 2);
  for (int col = static_cast<int>(x_min); col <= last; ++col) {
    const double begin = std::max(x_min, static_cast<double>(col));
    const double end = std::min(x_max, col + 1.0);
    const double height = x_max > x_min ? signed_height * (end - begin) / (x_max - x_min) : signed_height;
    const double left_part = 0.5 * (begin + end) - col;
    change[col] += static_cast<float>(height * (1.0 - left_part));
    change[col + 1] += static_cast<float>(height * left_part);
  }
}

cv::Mat1f CoverageBuffer::coverage() const {
  cv::Mat1f covered(column_change_.rows, column_change_.cols - 1);
  for (int row = 0; row < covered.rows; ++row) {
    const float* const change = column_change_[row];
    float* const out = covered[row];
    double sum = 0.0;
    for (int col = 0; col < covered.cols; ++col) {
      sum += static_cast<double>(change[col]);
      out[col] = static_cast<float>(sum);
    }
  }
  return covered;
}

}  // namespace tartan_calib::simulation
