#pragma once

#include <vector>

#include "placed_tag.h"
#include "tartan_calib/detection/lattice.h"

namespace tartan_calib::detection {

/// Reads the dark faces of a lattice, lets the decoded ones vote for the lattice's place on the board, and returns the tags
/// that agree with it. Everything else that looks like a tag is added to `counts`.
std::vector<PlacedTag> findLatticeTags(const BoardSearch& search, const SaddleLattice& lattice, DetectionCounts& counts);

}  // namespace tartan_calib::detection
