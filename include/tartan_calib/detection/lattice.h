#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "tartan_calib/detection/saddle.h"

namespace tartan_calib::detection {

/// A saddle with its place in a checker pattern.
struct LatticeNode {
  int column = 0;
  int row = 0;
  int saddle_index = -1;  ///< in the list that the lattice was grown from
};

/// Saddles joined by edges into the corners of a checker pattern whose columns and rows may have any widths: a
/// checkerboard, or an AprilGrid, which is one with wide and narrow columns and rows by turns. Columns and rows count from
/// 0 at an arbitrary corner; row direction follows column direction clockwise on the screen, so a lattice is never mirrored.
class SaddleLattice {
 public:
  /// `dark_parity`: 0 if faces with an even sum of column and row are dark, else 1.
  SaddleLattice(std::vector<LatticeNode> nodes, int dark_parity);

  const std::vector<LatticeNode>& nodes() const { return nodes_; }  ///< by increasing row, then column
  int numColumns() const { return num_columns_; }
  int numRows() const { return num_rows_; }

  /// Whether the face from (column, row) to (column + 1, row + 1) is dark.
  bool isDarkFace(int column, int row) const { return ((column + row) & 1) == dark_parity_; }

  /// Saddle at a place, -1 where there is none or outside.
  int saddleIndexAt(int column, int row) const;

 private:
  std::vector<LatticeNode> nodes_;
  int num_columns_ = 0;
  int num_rows_ = 0;
  int dark_parity_ = 0;
  std::vector<int> saddle_at_;  ///< row-major
};

/// Follows the edges from saddle to saddle, joins those that close to four-sided faces, and returns every patch of faces
/// that hang together by edges, largest first. Bent edges are followed; nothing is assumed about the board's size.
std::vector<SaddleLattice> growLattices(const cv::Mat& gray, const std::vector<Saddle>& saddles);

}  // namespace tartan_calib::detection
