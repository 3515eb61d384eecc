#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "tartan_calib/target/target.h"

namespace tartan_calib::simulation {

/// A printed board: a rectangular sheet cut by vertical and horizontal lines into cells that are black or white all over.
/// Target frame, seen from +z.
struct BoardPattern {
  std::vector<double> x_lines_m;    ///< increasing; the first and last are the edges of the sheet
  std::vector<double> y_lines_m;    ///< increasing
  std::vector<std::uint8_t> black;  ///< cell (col, row), row 0 at the lowest y: black[row * numCols() + col]

  int numCols() const { return static_cast<int>(x_lines_m.size()) - 1; }
  int numRows() const { return static_cast<int>(y_lines_m.size()) - 1; }
  bool isBlack(int col, int row) const {
    return black[static_cast<std::size_t>(row) * static_cast<std::size_t>(numCols()) + static_cast<std::size_t>(col)] != 0;
  }
};

/// The pattern as Kalibr prints it, with a white margin of `margin_m` around. Throws InputError for circle grids and for
/// boards that have more tags than their family.
BoardPattern boardPattern(const target::Target& target, double margin_m);

/// Half-width [m] of the square around a corner in which the corner is all there is to see: up to the payload of its tag and
/// half-way to the next corner.
double cornerHalfWindow(const target::Target& target);

}  // namespace tartan_calib::simulation
