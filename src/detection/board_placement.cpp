#include "board_placement.h"

#include <algorithm>
#include <array>

namespace tartan_calib::detection {
namespace {

/// Clockwise directions in a lattice: (column, row) steps.
const std::array<Eigen::Vector2i, 4>& directions() {
  static const std::array<Eigen::Vector2i, 4> steps = {Eigen::Vector2i(1, 0), Eigen::Vector2i(0, 1), Eigen::Vector2i(-1, 0),
                                                       Eigen::Vector2i(0, -1)};
  return steps;
}

/// Corners of a face from its first node, clockwise.
const std::array<Eigen::Vector2i, 4>& faceCorners() {
  static const std::array<Eigen::Vector2i, 4> corners = {Eigen::Vector2i(0, 0), Eigen::Vector2i(1, 0), Eigen::Vector2i(1, 1),
                                                         Eigen::Vector2i(0, 1)};
  return corners;
}

/// Steps to the right and up on the board, up to the placement's shift. Clockwise of the printed top edge comes the right
/// one.
Eigen::Vector2i turnedToBoard(int top_left, const Eigen::Vector2i& node) {
  const Eigen::Vector2i& right = directions()[static_cast<std::size_t>(top_left)];
  const Eigen::Vector2i& down = directions()[static_cast<std::size_t>((top_left + 1) % 4)];
  return {node.dot(right), -node.dot(down)};
}

}  // namespace

BoardPlacement::BoardPlacement(const target::AprilGrid& grid, const DecodedFace& face) : top_left_(face.top_left) {
  const Eigen::Vector2i top_left_node =
      Eigen::Vector2i(face.column, face.row) + faceCorners()[static_cast<std::size_t>(face.top_left)];
  const Eigen::Vector2i on_board(2 * (face.tag_index % grid.tag_cols), 2 * (face.tag_index / grid.tag_cols) + 1);
  shift_ = on_board - turnedToBoard(top_left_, top_left_node);
}

Eigen::Vector2i BoardPlacement::boardCorner(int column, int row) const {
  return shift_ + turnedToBoard(top_left_, Eigen::Vector2i(column, row));
}

std::optional<PlacementVote> votePlacement(const target::AprilGrid& grid, const std::vector<DecodedFace>& faces) {
  std::vector<PlacementVote> votes;
  for (const DecodedFace& face : faces) {
    const BoardPlacement placement(grid, face);
    const auto known =
        std::find_if(votes.begin(), votes.end(), [&](const PlacementVote& v) { return v.placement == placement; });
    if (known != votes.end()) {
      ++known->num_votes;
    } else {
      votes.push_back({placement, 1});
    }
  }
  std::stable_sort(votes.begin(), votes.end(),
                   [](const PlacementVote& a, const PlacementVote& b) { return a.num_votes > b.num_votes; });
  if (votes.empty() || (votes.size() > 1 && votes[0].num_votes == votes[1].num_votes)) {
    return std::nullopt;
  }
  return votes.front();
}

}  // namespace tartan_calib::detection
