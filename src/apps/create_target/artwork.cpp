#include "create_target/artwork.h"

#include "tartan_calib/simulation/board_pattern.h"
#include "tartan_calib/text.h"

namespace tartan_calib::apps {
namespace {

constexpr double kMmPerM = 1e3;

/// OpenCV's pattern generator draws discs of a fifth of the spacing; its detector wants white between them.
constexpr double kDiscRadiusOfSpacing = 0.2;

/// How the axes of the target frame lie on the page.
enum class Placement {
  kYUp,     ///< x to the right, y up
  kYRight,  ///< x down, y to the right: the same board turned by a quarter
};

/// Runs of black cells become one rectangle each. The outermost cells of a pattern are its margin, which has no width here.
void addCells(const simulation::BoardPattern& pattern, Placement placement, Artwork& artwork) {
  const double width_mm = kMmPerM * (pattern.x_lines_m.back() - pattern.x_lines_m.front());
  const double height_mm = kMmPerM * (pattern.y_lines_m.back() - pattern.y_lines_m.front());
  artwork.size_mm =
      placement == Placement::kYUp ? Eigen::Vector2d(width_mm, height_mm) : Eigen::Vector2d(height_mm, width_mm);
  const auto x_mm = [&](int col) {
    return kMmPerM * (pattern.x_lines_m[static_cast<std::size_t>(col)] - pattern.x_lines_m.front());
  };
  const auto y_mm = [&](int row) {
    return kMmPerM * (pattern.y_lines_m[static_cast<std::size_t>(row)] - pattern.y_lines_m.front());
  };
  for (int row = 0; row < pattern.numRows(); ++row) {
    for (int col = 0; col < pattern.numCols(); ++col) {
      const int begin = col;
      while (col < pattern.numCols() && pattern.isBlack(col, row)) {
        ++col;
      }
      if (col == begin) {
        continue;
      }
      const Eigen::Vector2d low(x_mm(begin), y_mm(row));
      const Eigen::Vector2d size(x_mm(col) - low.x(), y_mm(row + 1) - low.y());
      if (placement == Placement::kYUp) {
        artwork.rectangles.push_back({{low.x(), height_mm - low.y() - size.y()}, size});
      } else {
        artwork.rectangles.push_back({{low.y(), low.x()}, {size.y(), size.x()}});
      }
    }
  }
}

std::string mm(double length_m) { return format("%g", kMmPerM * length_m); }

struct ArtworkOf {
  Artwork operator()(const target::AprilGrid& grid) const {
    Artwork artwork;
    addCells(simulation::boardPattern(grid, 0.0), Placement::kYUp, artwork);
    artwork.caption = format(
        "AprilGrid of %d rows and %d columns, tags %s mm, spacing %g (%s mm), family %s, ids %d to %d, border of %d %s",
        grid.tag_rows, grid.tag_cols, mm(grid.tag_size_m).c_str(), grid.tag_spacing_ratio,
        mm(grid.tag_spacing_ratio * grid.tag_size_m).c_str(), grid.family.c_str(), grid.code_offset,
        grid.code_offset + target::numTags(grid) - 1, grid.border_cells, grid.border_cells == 1 ? "cell" : "cells");
    return artwork;
  }

  Artwork operator()(const target::Checkerboard& board) const {
    Artwork artwork;
    addCells(simulation::boardPattern(board, 0.0), Placement::kYRight, artwork);
    artwork.caption = format("Checkerboard of %d rows and %d columns of inner corners, squares %s mm wide and %s mm high",
                             board.rows, board.cols, mm(board.col_spacing_m).c_str(), mm(board.row_spacing_m).c_str());
    return artwork;
  }

  Artwork operator()(const target::CircleGrid& grid) const {
    Artwork artwork;
    const double margin_mm = 0.5 * kMmPerM * grid.spacing_m;  // half-way to where the next disc would be
    for (const Eigen::Vector3d& point : target::cornerPoints(grid)) {
      const Eigen::Vector2d right_down = grid.asymmetric ? point.head<2>() : Eigen::Vector2d(point.y(), point.x());
      const Eigen::Vector2d centre_mm = kMmPerM * right_down + Eigen::Vector2d::Constant(margin_mm);
      artwork.discs.push_back({centre_mm, kDiscRadiusOfSpacing * kMmPerM * grid.spacing_m});
      artwork.size_mm = artwork.size_mm.cwiseMax(centre_mm + Eigen::Vector2d::Constant(margin_mm));
    }
    artwork.caption = format("%s circle grid of %d rows and %d columns, spacing %s mm",
                             grid.asymmetric ? "Asymmetric" : "Symmetric", grid.rows, grid.cols, mm(grid.spacing_m).c_str());
    return artwork;
  }
};

}  // namespace

Artwork makeArtwork(const target::Target& target) { return std::visit(ArtworkOf{}, target); }

}  // namespace tartan_calib::apps
