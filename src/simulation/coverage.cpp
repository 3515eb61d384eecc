#include "tartan_calib/simulation/coverage.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tartan_calib::simulation {
namespace {

Eigen::Vector2d pointAtX(const Eigen::Vector2d& from, const Eigen::Vector2d& to, double x) {
  return {x, from.y() + (to.y() - from.y()) * (x - from.x()) / (to.x() - from.x())};
}

/// Safe for edges far below the window, which no row shows.
int rowAt(double y) { return static_cast<int>(std::min<double>(y, std::numeric_limits<int>::max() - 1)); }

}  // namespace

CoverageBuffer::CoverageBuffer(const cv::Rect& window)
    : origin_(window.x - 0.5, window.y - 0.5),
      column_change_(window.height, window.width + 1, 0.0F),
      shift_derivative_(window.height, window.width, cv::Vec2f(0.0F, 0.0F)) {}

void CoverageBuffer::addEdge(const Eigen::Vector2d& from_px, const Eigen::Vector2d& to_px, double weight) {
  const Eigen::Vector2d origin(origin_.x, origin_.y);
  Eigen::Vector2d left = from_px - origin;
  Eigen::Vector2d right = to_px - origin;
  if (left.x() > right.x()) {
    left.swap(right);
    weight = -weight;
  }
  const double width = shift_derivative_.cols;
  if (left.x() >= width) {
    return;
  }
  if (right.x() > width) {
    right = pointAtX(left, right, width);
  }
  if (right.x() <= 0.0) {
    addLeftOf(left.y(), right.y(), weight);
    return;
  }
  if (left.x() < 0.0) {
    const Eigen::Vector2d entry = pointAtX(left, right, 0.0);
    addLeftOf(left.y(), entry.y(), weight);
    left = entry;
  }
  addInsideColumns(left, right, weight);
}

/// An edge outside of the window on its left: all of its rows lie to its right.
void CoverageBuffer::addLeftOf(double y_from, double y_to, double weight) {
  const double sign = y_to > y_from ? weight : -weight;
  const double bottom = std::min<double>(column_change_.rows, std::max(y_from, y_to));
  double y = std::max(0.0, std::min(y_from, y_to));
  for (int row = rowAt(y); y < bottom; ++row) {
    const double y_end = std::min(bottom, row + 1.0);
    column_change_(row, 0) += static_cast<float>(sign * (y_end - y));
    y = y_end;
  }
}

void CoverageBuffer::addInsideColumns(const Eigen::Vector2d& from, const Eigen::Vector2d& to, double weight) {
  const Eigen::Vector2d step = to - from;
  if (step.y() == 0.0) {
    const bool is_inside = from.y() >= 0.0 && from.y() < column_change_.rows;
    if (is_inside) {
      addRowPiece({static_cast<int>(from.y()), from.x(), to.x(), 0.0, weight * step.x()});
    }
    return;
  }
  const double slope = step.x() / step.y();
  const double direction = step.y() > 0.0 ? weight : -weight;
  const double bottom = std::min<double>(column_change_.rows, std::max(from.y(), to.y()));
  const auto x_at = [&](double y) {
    return std::clamp(from.x() + slope * (y - from.y()), std::min(from.x(), to.x()), std::max(from.x(), to.x()));
  };
  double y = std::max(0.0, std::min(from.y(), to.y()));
  for (int row = rowAt(y); y < bottom; ++row) {
    const double y_end = std::min(bottom, row + 1.0);
    const double x = x_at(y);
    const double x_end = x_at(y_end);
    addRowPiece({row, x, x_end, direction * (y_end - y), direction * (x_end - x)});
    y = y_end;
  }
}

void CoverageBuffer::addRowPiece(const RowPiece& piece) {
  const double x_min = std::min(piece.x_from, piece.x_to);
  const double x_max = std::max(piece.x_from, piece.x_to);
  float* const change = column_change_[piece.row];
  cv::Vec2f* const derivative = shift_derivative_[piece.row];
  const int last = std::min(static_cast<int>(x_max), shift_derivative_.cols - 1);
  for (int col = static_cast<int>(x_min); col <= last; ++col) {
    const double begin = std::max(x_min, static_cast<double>(col));
    const double end = std::min(x_max, col + 1.0);
    const double part = x_max > x_min ? (end - begin) / (x_max - x_min) : 1.0;
    const double height = piece.signed_height * part;
    const double left_part = 0.5 * (begin + end) - col;
    change[col] += static_cast<float>(height * (1.0 - left_part));
    change[col + 1] += static_cast<float>(height * left_part);
    derivative[col] += cv::Vec2f(static_cast<float>(-height), static_cast<float>(piece.signed_width * part));
  }
}

cv::Mat1f CoverageBuffer::coverage() const {
  cv::Mat1f covered(shift_derivative_.size());
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
