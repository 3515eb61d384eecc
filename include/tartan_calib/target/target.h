#pragma once

#include <Eigen/Core>
#include <string>
#include <variant>
#include <vector>

namespace tartan_calib::target {

/// Kalibr's grid of AprilTags with a small black square at every tag corner. Tag (row, col) has id
/// `code_offset + row * tag_cols + col`; row 0 is at the bottom of the board, col 0 at the left.
struct AprilGrid {
  int tag_rows = 6;
  int tag_cols = 6;
  double tag_size_m = 0.088;       ///< outer edge to outer edge of the black square
  double tag_spacing_ratio = 0.3;  ///< gap between tags / tag size
  std::string family = "t36h11";
  int code_offset = 0;   ///< id of tag (0, 0)
  int border_cells = 2;  ///< width of the black border; Kalibr prints 2, stock AprilTag 1
};

/// Checkerboard by its inner corners. As in Kalibr, x runs along the rows.
struct Checkerboard {
  int rows = 0;  ///< inner corners
  int cols = 0;
  double row_spacing_m = 0.0;
  double col_spacing_m = 0.0;
};

/// Circle grid in OpenCV's layouts.
struct CircleGrid {
  int rows = 0;
  int cols = 0;
  double spacing_m = 0.0;
  bool asymmetric = false;
};

using Target = std::variant<AprilGrid, Checkerboard, CircleGrid>;

/// Corners form a lattice; the id of the corner at (row, col) is `row * cols + col`.
/// AprilGrid: two lattice rows and columns per tag, (0, 0) = bottom-left corner of tag (0, 0).
struct Lattice {
  int rows = 0;
  int cols = 0;
};

Lattice cornerLattice(const Target& target);

int numCorners(const Target& target);

/// Position of every corner in the target frame [m], z = 0, by corner id. AprilGrid: x right, y up, origin at corner 0,
/// z towards the viewer.
std::vector<Eigen::Vector3d> cornerPoints(const Target& target);

/// Half the width [m] of the square around every corner in which the board looks the same after half a turn about the
/// corner: an AprilGrid's black border and corner squares; a quarter of a checkerboard's fields, which may carry marks
/// farther in. 0 for circle grids, which have no X-corners.
double symmetricHalfWidth(const Target& target);

/// Which diagonal quadrants around a corner are dark: +1 those where x and y have the same sign, -1 the others, 0 where the
/// target does not say (a checkerboard may be printed either way).
int darkDiagonal(const Target& target, int corner_id);

/// Number of tags of an AprilGrid.
inline int numTags(const AprilGrid& grid) { return grid.tag_rows * grid.tag_cols; }

/// Corner ids of the tag at index `row * tag_cols + col`, in the order bottom-left, bottom-right, top-right, top-left.
std::vector<int> tagCornerIds(const AprilGrid& grid, int tag_index);

}  // namespace tartan_calib::target
