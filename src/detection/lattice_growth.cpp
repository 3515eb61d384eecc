#include "lattice_growth.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <optional>

#include "lattice_map.h"
#include "square_edge.h"

namespace tartan_calib::detection {
namespace {

constexpr double kNoLimit = std::numeric_limits<double>::infinity();
// Edges from an outer corner that are followed up, the likeliest ones.
constexpr std::size_t kMaxCandidates = 3;
// A square's side is at most so many times as long as the opposite side of the square before it.
constexpr double kMaxGrowth_ratio = 3.0;

// Between a saddle and where the corners around say that it is, in units of the shorter side of a square.
constexpr double kMaxDeviationSquares = 0.25;
constexpr double kMinArmCosine = 0.9;  // 26 degrees, an arm's error and the map's

/// The clockwise directions: next column, next row, previous column, previous row.
constexpr std::array<LatticePlace, 4> kSteps{LatticePlace{1, 0}, LatticePlace{0, 1}, LatticePlace{-1, 0},
                                             LatticePlace{0, -1}};

LatticePlace step(const LatticePlace& place, int direction) {
  const LatticePlace& s = kSteps[static_cast<std::size_t>(direction % 4)];
  return {place.first + s.first, place.second + s.second};
}

/// A saddle in the lattice; `first_arm` is the one towards the next column, the others follow clockwise.
struct Node {
  int saddle_index = -1;
  int first_arm = 0;

  ArmLink towards(int direction) const { return {saddle_index, (first_arm + direction) % 4}; }
};

struct Candidate {
  Node node;
  double cost_px;
};

class LatticeGrower {
 public:
  LatticeGrower(const cv::Mat& gray, const std::vector<Saddle>& saddles, const SaddleLattice& lattice)
      : gray_(gray), saddles_(saddles), taken_(saddles.size(), false), dark_parity_(lattice.isDarkFace(0, 0) ? 0 : 1) {
    for (const LatticeNode& node : lattice.nodes()) {
      add({node.column, node.row}, {node.saddle_index, firstArm(lattice, node)});
    }
  }

  void grow() {
    while (closeSquares() || addPredicted()) {
    }
  }

  SaddleLattice result() const {
    LatticePlace first{0, 0};
    for (const auto& entry : nodes_) {
      first = {std::min(first.first, entry.first.first), std::min(first.second, entry.first.second)};
    }
    std::vector<LatticeNode> nodes;
    for (const auto& [place, node] : nodes_) {
      nodes.push_back({place.first - first.first, place.second - first.second, node.saddle_index});
    }
    std::sort(nodes.begin(), nodes.end(), [](const LatticeNode& a, const LatticeNode& b) {
      return a.row != b.row ? a.row < b.row : a.column < b.column;
    });
    return {std::move(nodes), (dark_parity_ + first.first + first.second) & 1};
  }

 private:
  const Saddle& saddle(int index) const { return saddles_[static_cast<std::size_t>(index)]; }

  void add(const LatticePlace& place, const Node& node) {
    nodes_.emplace(place, node);
    taken_[static_cast<std::size_t>(node.saddle_index)] = true;
  }

  /// The arm towards the next column, as colours and any neighbour tell.
  int firstArm(const SaddleLattice& lattice, const LatticeNode& node) const {
    const int parity = lattice.isDarkFace(node.column, node.row) ? 0 : 1;
    for (int d = 0; d < 4; ++d) {
      const LatticePlace next = step({node.column, node.row}, d);
      const int neighbour = lattice.saddleIndexAt(next.first, next.second);
      if (neighbour >= 0) {
        const Eigen::Vector2d chord = saddle(neighbour).px - saddle(node.saddle_index).px;
        const double arm_rad = saddle(node.saddle_index).arm_rad[static_cast<std::size_t>((parity + d) % 4)];
        const bool opposite = std::cos(std::atan2(chord.y(), chord.x()) - arm_rad) < 0.0;
        return opposite ? parity + 2 : parity;
      }
    }
    return parity;
  }

  bool closeSquares() {
    bool grown = false;
    const std::map<LatticePlace, Node> nodes = nodes_;
    for (const auto& entry : nodes) {
      for (int direction = 0; direction < 4; ++direction) {
        grown = closeSquare(entry.first, direction) || grown;
      }
    }
    return grown;
  }

  /// Where the edge from `place` in a direction may lead: to the node that is there, else to free saddles.
  std::vector<Candidate> ahead(const LatticePlace& place, int direction, double max_length_px) const {
    const auto there = nodes_.find(step(place, direction));
    if (there != nodes_.end()) {
      return {{there->second, 0.0}};
    }
    const ArmLink from = nodes_.at(place).towards(direction);
    std::vector<Candidate> candidates;
    for (int i = 0; i < static_cast<int>(saddles_.size()); ++i) {
      if (taken_[static_cast<std::size_t>(i)] || (saddle(i).px - saddle(from.saddle_index).px).norm() > max_length_px) {
        continue;
      }
      for (int arm = (from.arm + 1) % 2; arm < 4; arm += 2) {
        if (const auto cost_px = squareEdgeCost(gray_, saddles_, from, {i, arm})) {
          // The arm that goes on in the direction is opposite to the one that arrives.
          candidates.push_back({{i, (arm + 6 - direction) % 4}, *cost_px});
        }
      }
    }
    std::sort(candidates.begin(), candidates.end(), [](const Candidate& a, const Candidate& b) {
      return a.cost_px != b.cost_px ? a.cost_px < b.cost_px : a.node.saddle_index < b.node.saddle_index;
    });
    candidates.resize(std::min(candidates.size(), kMaxCandidates));
    return candidates;
  }

  /// Adds what is missing of the square that lies in a direction of the side from `place` to the next place clockwise.
  bool closeSquare(const LatticePlace& place, int direction) {
    const int along = (direction + 1) % 4;
    const LatticePlace other = step(place, along);
    const LatticePlace near_place = step(place, direction);
    const LatticePlace far_place = step(other, direction);
    if (nodes_.count(other) == 0 || (nodes_.count(near_place) > 0 && nodes_.count(far_place) > 0)) {
      return false;
    }
    double least_px = kNoLimit;
    std::optional<std::pair<Node, Node>> best;
    const auto fars = ahead(other, direction, maxLength(other, direction));
    for (const Candidate& near : ahead(place, direction, maxLength(place, direction))) {
      for (const Candidate& far : fars) {
        const auto cost_px = squareEdgeCost(gray_, saddles_, near.node.towards(along), far.node.towards(along + 2));
        if (cost_px && near.cost_px + far.cost_px + *cost_px < least_px) {
          least_px = near.cost_px + far.cost_px + *cost_px;
          best = {near.node, far.node};
        }
      }
    }
    if (best) {
      add(near_place, best->first);
      add(far_place, best->second);
    }
    return best.has_value();
  }

  double maxLength(const LatticePlace& place, int direction) const {
    const auto behind = nodes_.find(step(place, direction + 2));
    if (behind == nodes_.end()) {
      return kNoLimit;
    }
    return kMaxGrowth_ratio * (saddle(behind->second.saddle_index).px - saddle(nodes_.at(place).saddle_index).px).norm();
  }

  /// Adds saddles that lie at the end of an edge where the lattice predicts them, as beyond a hidden corner, whose squares
  /// do not close.
  bool addPredicted() {
    std::map<LatticePlace, Eigen::Vector2d> corners_px;
    for (const auto& [place, node] : nodes_) {
      corners_px[place] = saddle(node.saddle_index).px;
    }
    std::map<LatticePlace, Node> found;
    for (const auto& entry : nodes_) {
      for (int direction = 0; direction < 4; ++direction) {
        const LatticePlace place = step(entry.first, direction);
        const auto map = nodes_.count(place) == 0 ? fitLatticeMap(corners_px, place, false) : std::nullopt;
        for (const Candidate& candidate : map ? ahead(entry.first, direction, kNoLimit) : std::vector<Candidate>{}) {
          if (fits(candidate.node, *map)) {
            found.emplace(place, candidate.node);
          }
        }
      }
    }
    for (const auto& [place, node] : found) {
      if (!taken_[static_cast<std::size_t>(node.saddle_index)]) {
        add(place, node);
      }
    }
    return !found.empty();
  }

  /// True if a saddle is where a map says and its arms lead where the map's axes do.
  bool fits(const Node& node, const LatticeMap& map) const {
    const Eigen::Vector2d deviation_px = saddle(node.saddle_index).px - map.centre_px();
    if (deviation_px.norm() > kMaxDeviationSquares * map.minSpacing_px()) {
      return false;
    }
    for (int direction = 0; direction < 4; ++direction) {
      const LatticePlace& ahead = kSteps[static_cast<std::size_t>(direction)];
      const Eigen::Vector2d axis_px = map.J_px_offset() * Eigen::Vector2d(ahead.first, ahead.second);
      const double arm_rad = saddle(node.saddle_index).arm_rad[static_cast<std::size_t>(node.towards(direction).arm)];
      if (axis_px.x() * std::cos(arm_rad) + axis_px.y() * std::sin(arm_rad) < kMinArmCosine * axis_px.norm()) {
        return false;
      }
    }
    return true;
  }

  const cv::Mat& gray_;
  const std::vector<Saddle>& saddles_;
  std::vector<bool> taken_;
  int dark_parity_;  ///< 0 if faces with an even sum of column and row are dark, else 1
  std::map<LatticePlace, Node> nodes_;
};

}  // namespace

SaddleLattice extendLattice(const cv::Mat& gray, const std::vector<Saddle>& saddles, const SaddleLattice& lattice) {
  LatticeGrower grower(gray, saddles, lattice);
  grower.grow();
  return grower.result();
}

}  // namespace tartan_calib::detection
