#pragma once

#include <array>
#include <optional>
#include <vector>

#include "board_placement.h"
#include "placed_tag.h"

namespace tartan_calib::detection {

/// A dark face of a lattice, and what it shows if it is a tag.
struct TagFace {
  int column;
  int row;
  std::array<int, 4> saddle_index;  ///< clockwise from the node (column, row)
  TagMap map;
  std::optional<TagReading> reading;
  std::optional<TagMatch> match;
  bool has_other_border = false;  ///< a tag, but with the other border width; reading and match are empty then
};

/// Index of the tag that a face is under a placement; nothing for the squares between tags and beyond the board.
std::optional<int> tagAt(const target::AprilGrid& grid, const BoardPlacement& placement, const TagFace& face);

/// The lattice's place on the board that most decoded faces vote for; nothing where so few could be chance, or where two
/// places have equally many.
std::optional<PlacementVote> placeByVotes(const BoardSearch& search, const std::vector<TagFace>& faces);

/// Rows and columns of the board as its ids run from row to row, where that is another number of columns than the target's;
/// nothing where most faces agree with `vote_on_target`, their place on the target, or no other size explains clearly more
/// of them.
std::optional<BoardSize> otherSize(const BoardSearch& search, const std::vector<TagFace>& faces,
                                   const std::optional<PlacementVote>& vote_on_target);

/// The place where the payloads, taken together, look like the board's, where no other comes near: for images so blurred
/// that no single tag can be decoded.
std::optional<PlacementVote> placeByLooks(const BoardSearch& search, const std::vector<TagFace>& faces);

}  // namespace tartan_calib::detection
