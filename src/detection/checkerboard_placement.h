#pragma once

#include <map>
#include <optional>
#include <vector>

#include "lattice_map.h"
#include "tartan_calib/detection/lattice.h"
#include "tartan_calib/detection/target_detector.h"
#include "tartan_calib/target/target.h"

namespace tartan_calib::detection {

/// Corners of a board that were seen, by (row, column) on the board.
struct PlacedCorners {
  std::map<LatticePlace, Saddle> saddles;
  bool dark_ahead = false;  ///< the square between (0, 0) and (1, 1) is dark
};

/// Tells which corners of the board a lattice shows. A checkerboard has no marks, so that is known only where the lattice
/// is as large as the board: all rows and all columns were found. Outer lines with less than half of their corners do not
/// count, corners missing elsewhere do not matter. Nothing where the size differs.
///
/// Of the ways to turn the board that fit, the one with a dark square beyond corner 0, on the diagonal, is taken: with one
/// of rows and columns even and the other odd there is exactly one. Where colours do not tell (both odd: half a turn; both
/// even: half a turn, or a quarter turn of a square board), rows and columns run towards the lower right of the image.
std::optional<PlacedCorners> placeOnBoard(const SaddleLattice& lattice, const std::vector<Saddle>& saddles,
                                          const target::Checkerboard& board);

/// Whether most corners lie where their neighbours in the lattice predict them. Those of a board do, through any lens;
/// saddles that letters or tiles happen to link to a lattice of a board's size do not.
bool isRegular(const SaddleLattice& lattice, const std::vector<Saddle>& saddles);

/// The size of the checkerboard that a lattice shows; nothing where many of its corners are missing.
std::optional<BoardSize> shownSize(const SaddleLattice& lattice);

}  // namespace tartan_calib::detection
