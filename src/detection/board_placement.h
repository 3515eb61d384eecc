#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "tag_reader.h"
#include "tartan_calib/target/target.h"

namespace tartan_calib::detection {

/// A face of a lattice that decoded as a tag. The face's corner 0 is the node (column, row); the others follow clockwise.
struct DecodedFace {
  int column = 0;
  int row = 0;
  int tag_index = -1;  ///< on the board: row * tag_cols + col
  int top_left = 0;    ///< corner of the face that is the printed tag's top left one
};

/// Which corner of the board a node of a lattice is: one of four turns and a shift.
class BoardPlacement {
 public:
  /// The only placement under which `face` is the tag that it decoded as.
  BoardPlacement(const target::AprilGrid& grid, const DecodedFace& face);

  /// Board lattice coordinates (x right, y up) of a node.
  Eigen::Vector2i boardCorner(int column, int row) const;

  int topLeft() const { return top_left_; }

  friend bool operator==(const BoardPlacement& a, const BoardPlacement& b) {
    return a.top_left_ == b.top_left_ && a.shift_ == b.shift_;
  }

 private:
  int top_left_;
  Eigen::Vector2i shift_ = Eigen::Vector2i::Zero();
};

/// A placement and how many faces vote for it.
struct PlacementVote {
  BoardPlacement placement;
  int num_votes = 0;
};

/// The placement that most faces vote for; nothing without faces or where two have equally many.
std::optional<PlacementVote> votePlacement(const target::AprilGrid& grid, const std::vector<DecodedFace>& faces);

}  // namespace tartan_calib::detection
