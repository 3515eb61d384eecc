#pragma once

#include <set>
#include <vector>

#include "placed_tag.h"

namespace tartan_calib::detection {

/// Looks for the board's tags that are missing beside those found: where the neighbours say that their corners are, a tag is
/// added if there are saddles of the right polarity, all but one at most, and its payload can be read between them. Tags
/// whose index is in `excluded` are not looked for. Leaves all maps bent.
void completeBoard(const BoardSearch& search, const std::set<int>& excluded, std::vector<PlacedTag>& tags);

/// Bends the map of every tag towards the corners of the tags around it.
void bendMaps(const BoardSearch& search, std::vector<PlacedTag>& tags);

}  // namespace tartan_calib::detection
