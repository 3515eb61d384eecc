#include "tartan_calib/target/target.h"

#include <algorithm>

#include "tartan_calib/target/tag_family.h"

namespace tartan_calib::target {
namespace {

struct LatticeOf {
  Lattice operator()(const AprilGrid& grid) const { return {2 * grid.tag_rows, 2 * grid.tag_cols}; }
  Lattice operator()(const Checkerboard& board) const { return {board.rows, board.cols}; }
  Lattice operator()(const CircleGrid& grid) const { return {grid.rows, grid.cols}; }
};

struct PointAt {
  int row;
  int col;

  Eigen::Vector3d operator()(const AprilGrid& grid) const {
    const auto along = [&grid](int i) {
      return (i / 2) * (1.0 + grid.tag_spacing_ratio) * grid.tag_size_m + (i % 2) * grid.tag_size_m;
    };
    return {along(col), along(row), 0.0};
  }
  Eigen::Vector3d operator()(const Checkerboard& board) const {
    return {board.row_spacing_m * row, board.col_spacing_m * col, 0.0};
  }
  Eigen::Vector3d operator()(const CircleGrid& grid) const {
    if (grid.asymmetric) {
      return {(2 * col + row % 2) * grid.spacing_m, row * grid.spacing_m, 0.0};
    }
    return {grid.spacing_m * row, grid.spacing_m * col, 0.0};
  }
};

}  // namespace

Lattice cornerLattice(const Target& target) { return std::visit(LatticeOf{}, target); }

int numCorners(const Target& target) {
  const Lattice lattice = cornerLattice(target);
  return lattice.rows * lattice.cols;
}

std::vector<Eigen::Vector3d> cornerPoints(const Target& target) {
  const Lattice lattice = cornerLattice(target);
  std::vector<Eigen::Vector3d> points;
  for (int row = 0; row < lattice.rows; ++row) {
    for (int col = 0; col < lattice.cols; ++col) {
      points.push_back(std::visit(PointAt{row, col}, target));
    }
  }
  return points;
}

double symmetricHalfWidth(const Target& target) {
  if (const auto* board = std::get_if<Checkerboard>(&target)) {
    constexpr double kPlainShare = 0.25;
    return kPlainShare * std::min(board->row_spacing_m, board->col_spacing_m);
  }
  if (const auto* grid = std::get_if<AprilGrid>(&target)) {
    const int tag_cells = tagFamily(grid->family).payload_cells + 2 * grid->border_cells;
    return grid->tag_size_m * std::min(static_cast<double>(grid->border_cells) / tag_cells, grid->tag_spacing_ratio);
  }
  return 0.0;
}

int darkDiagonal(const Target& target, int corner_id) {
  if (!std::holds_alternative<AprilGrid>(target)) {
    return 0;
  }
  // The tag lies towards +x +y of its bottom-left corner, towards -x +y of its bottom-right one, and so on.
  const int cols = cornerLattice(target).cols;
  return (corner_id / cols + corner_id % cols) % 2 == 0 ? 1 : -1;
}

std::vector<int> tagCornerIds(const AprilGrid& grid, int tag_index) {
  const int lattice_cols = 2 * grid.tag_cols;
  const int base = (tag_index / grid.tag_cols) * 2 * lattice_cols + (tag_index % grid.tag_cols) * 2;
  return {base, base + 1, base + lattice_cols + 1, base + lattice_cols};
}

}  // namespace tartan_calib::target
