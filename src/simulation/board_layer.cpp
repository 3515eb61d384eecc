#include "tartan_calib/simulation/board_layer.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

#include "curve.h"
#include "tartan_calib/simulation/coverage.h"

namespace tartan_calib::simulation {
namespace {

/// A cell whose side spans more than this part of the image straddles a direction that the model cannot image.
constexpr double kMaxSideOfImage = 0.5;

/// What a cell shows.
struct Shade {
  double sheet = 0.0;
  double white = 0.0;
};

/// The lattice of the pattern's lines, projected.
class ProjectedPattern {
 public:
  ProjectedPattern(const BoardPattern& pattern, const camera::Camera& camera, const geometry::Rigid3& T_cam_target)
      : pattern_(pattern), camera_(camera), T_cam_target_(T_cam_target) {
    const Eigen::Vector3d camera_in_target = T_cam_target.inverse().translation;
    is_front_ = camera_in_target.z() > 0.0;
    for (const double y_m : pattern.y_lines_m) {
      for (const double x_m : pattern.x_lines_m) {
        vertices_.push_back(project({x_m, y_m}));
      }
    }
  }

  bool isFront() const { return is_front_; }

  const std::optional<Eigen::Vector2d>& vertex(int col, int row) const {
    return vertices_[static_cast<std::size_t>(row) * pattern_.x_lines_m.size() + static_cast<std::size_t>(col)];
  }

  /// Nothing outside of the sheet and for cells without an image.
  Shade shade(int col, int row) const {
    if (col < 0 || row < 0 || col >= pattern_.numCols() || row >= pattern_.numRows() || !isImaged(col, row)) {
      return {};
    }
    return {1.0, is_front_ && pattern_.isBlack(col, row) ? 0.0 : 1.0};
  }

  /// Smallest window of whole pixels with all imaged cells, cut to the image.
  cv::Rect window() const {
    Eigen::Vector2d low = Eigen::Vector2d::Constant(1e9);
    Eigen::Vector2d high = -low;
    for (const auto& px : vertices_) {
      if (px) {
        low = low.cwiseMin(*px);
        high = high.cwiseMax(*px);
      }
    }
    // Sides may bulge beyond the vertices by a fraction of a cell.
    constexpr double kMarginPx = 8.0;
    const auto floor_in = [](double v, int size) { return static_cast<int>(std::clamp<double>(v, 0.0, size)); };
    const cv::Point begin(floor_in(low.x() - kMarginPx, camera_.width), floor_in(low.y() - kMarginPx, camera_.height));
    const cv::Point end(floor_in(high.x() + kMarginPx, camera_.width), floor_in(high.y() + kMarginPx, camera_.height));
    return begin.x < end.x && begin.y < end.y ? cv::Rect(begin, end) : cv::Rect();
  }

  std::optional<Eigen::Vector2d> project(const Eigen::Vector2d& p_target) const {
    return camera::project(camera_.model, T_cam_target_ * Eigen::Vector3d(p_target.x(), p_target.y(), 0.0));
  }

  Eigen::Vector2d linePoint(int col, int row) const {
    return {pattern_.x_lines_m[static_cast<std::size_t>(col)], pattern_.y_lines_m[static_cast<std::size_t>(row)]};
  }

 private:
  bool isImaged(int col, int row) const {
    const auto& a = vertex(col, row);
    const auto& b = vertex(col + 1, row);
    const auto& c = vertex(col + 1, row + 1);
    const auto& d = vertex(col, row + 1);
    if (!a || !b || !c || !d) {
      return false;
    }
    const double side_px = std::max({(*a - *b).norm(), (*b - *c).norm(), (*c - *d).norm(), (*d - *a).norm()});
    return side_px < kMaxSideOfImage * std::max(camera_.width, camera_.height);
  }

  const BoardPattern& pattern_;
  const camera::Camera& camera_;
  const geometry::Rigid3& T_cam_target_;
  bool is_front_ = true;
  std::vector<std::optional<Eigen::Vector2d>> vertices_;
};

/// Draws cell boundaries, each once, with the difference between its two sides.
class BoardPainter {
 public:
  BoardPainter(const ProjectedPattern& board, const cv::Rect& window) : board_(board), sheet_(window), white_(window) {}

  /// The side from vertex (col, row) to (to_col, to_row), with what lies on its left and right seen from the front.
  void addSide(const cv::Point& from, const cv::Point& to, const Shade& left, const Shade& right) {
    const double sign = board_.isFront() ? 1.0 : -1.0;
    const double sheet = sign * (left.sheet - right.sheet);
    const double white = sign * (left.white - right.white);
    if (sheet == 0.0 && white == 0.0) {
      return;
    }
    const Eigen::Vector2d a = board_.linePoint(from.x, from.y);
    const Eigen::Vector2d b = board_.linePoint(to.x, to.y);
    Eigen::Vector2d previous = *board_.vertex(from.x, from.y);
    const auto along = [&](double s) { return board_.project(a + s * (b - a)); };
    for (const Eigen::Vector2d& px : imageOfLine(previous, *board_.vertex(to.x, to.y), along)) {
      if (sheet != 0.0) {
        sheet_.addEdge(previous, px, sheet);
      }
      if (white != 0.0) {
        white_.addEdge(previous, px, white);
      }
      previous = px;
    }
  }

  BoardLayer layer(const cv::Rect& window) const {
    return {window, sheet_.coverage(), white_.coverage(), white_.shiftDerivative()};
  }

 private:
  const ProjectedPattern& board_;
  CoverageBuffer sheet_;
  CoverageBuffer white_;
};

}  // namespace

BoardLayer drawBoard(const BoardPattern& pattern, const camera::Camera& camera, const geometry::Rigid3& T_cam_target) {
  const ProjectedPattern board(pattern, camera, T_cam_target);
  const cv::Rect window = board.window();
  if (window.empty()) {
    return {};
  }
  BoardPainter painter(board, window);
  for (int row = 0; row <= pattern.numRows(); ++row) {
    for (int col = 0; col <= pattern.numCols(); ++col) {
      const Shade above_right = board.shade(col, row);
      painter.addSide({col, row}, {col + 1, row}, above_right, board.shade(col, row - 1));
      painter.addSide({col, row}, {col, row + 1}, board.shade(col - 1, row), above_right);
    }
  }
  return painter.layer(window);
}

}  // namespace tartan_calib::simulation
