#include "tartan_calib/detection/lattice.h"

#include <algorithm>
#include <array>
#include <deque>
#include <limits>
#include <optional>
#include <tuple>

#include "edge_trace.h"

namespace tartan_calib::detection {
namespace {

/// The clockwise neighbour directions: next column, next row, previous column, previous row.
constexpr std::array<int, 4> kColumnStep = {1, 0, -1, 0};
constexpr std::array<int, 4> kRowStep = {0, 1, 0, -1};

/// Place of a saddle: arm k points in direction (k + turn) % 4.
struct Place {
  int column = 0;
  int row = 0;
  int turn = 0;
  int patch = -1;
};

ArmLink linkOf(const std::vector<ArmLinks>& links, const ArmLink& end) {
  return links[static_cast<std::size_t>(end.saddle_index)][static_cast<std::size_t>(end.arm)];
}

ArmLink turned(const ArmLink& end, int quarter_turns) { return {end.saddle_index, (end.arm + quarter_turns + 4) % 4}; }

/// Corners of the face clockwise of `start`, each with the arm that leads on to the next; nothing if it does not close.
std::optional<std::array<ArmLink, 4>> faceAt(const std::vector<ArmLinks>& links, const ArmLink& start) {
  std::array<ArmLink, 4> face{};
  ArmLink leaving = start;
  for (ArmLink& corner : face) {
    corner = leaving;
    const ArmLink arriving = linkOf(links, leaving);
    if (arriving.saddle_index < 0) {
      return std::nullopt;
    }
    leaving = turned(arriving, -1);
  }
  if (leaving.saddle_index != start.saddle_index || leaving.arm != start.arm) {
    return std::nullopt;
  }
  for (std::size_t k = 0; k < 2; ++k) {
    if (face[k].saddle_index == face[k + 2].saddle_index) {
      return std::nullopt;
    }
  }
  return face;
}

bool isConvex(const std::vector<Saddle>& saddles, const std::array<ArmLink, 4>& face) {
  const auto px = [&](std::size_t k) { return saddles[static_cast<std::size_t>(face[k % 4].saddle_index)].px; };
  for (std::size_t k = 0; k < 4; ++k) {
    const Eigen::Vector2d side = px(k + 1) - px(k);
    const Eigen::Vector2d next = px(k + 2) - px(k + 1);
    if (side.x() * next.y() - side.y() * next.x() <= 0.0) {
      return false;
    }
  }
  return true;
}

/// Faces that close, by the arm of the corner that they lie clockwise of.
class FaceTable {
 public:
  FaceTable(const std::vector<Saddle>& saddles, const std::vector<ArmLinks>& links)
      : links_(links), closed_(saddles.size()) {
    for (std::size_t i = 0; i < saddles.size(); ++i) {
      for (int arm = 0; arm < 4; ++arm) {
        const auto face = faceAt(links, {static_cast<int>(i), arm});
        closed_[i][static_cast<std::size_t>(arm)] = face && isConvex(saddles, *face);
      }
    }
  }

  bool isClosed(const ArmLink& start) const {
    return closed_[static_cast<std::size_t>(start.saddle_index)][static_cast<std::size_t>(start.arm)];
  }

  /// True for an edge with a closed face on at least one side.
  bool isFaceEdge(const ArmLink& start) const {
    const ArmLink end = linkOf(links_, start);
    return end.saddle_index >= 0 && (isClosed(start) || isClosed(end));
  }

 private:
  const std::vector<ArmLinks>& links_;
  std::vector<std::array<bool, 4>> closed_;
};

/// Gives places to all saddles that hang together with `seed` by edges of faces. A saddle reached twice with different
/// places is left out: its links contradict each other.
std::vector<int> growPatch(const std::vector<ArmLinks>& links, const FaceTable& faces, int seed,
                           std::vector<Place>& places) {
  std::vector<int> members;
  std::vector<int> contradicted;
  std::deque<int> queue = {seed};
  const int patch = seed;
  places[static_cast<std::size_t>(seed)] = {0, 0, 0, patch};
  while (!queue.empty()) {
    const int current = queue.front();
    queue.pop_front();
    members.push_back(current);
    const Place here = places[static_cast<std::size_t>(current)];
    for (int arm = 0; arm < 4; ++arm) {
      if (!faces.isFaceEdge({current, arm})) {
        continue;
      }
      const ArmLink there = linkOf(links, {current, arm});
      const auto direction = static_cast<std::size_t>((arm + here.turn) % 4);
      const Place expected = {here.column + kColumnStep[direction], here.row + kRowStep[direction],
                              (arm + here.turn + 2 - there.arm + 4) % 4, patch};
      Place& place = places[static_cast<std::size_t>(there.saddle_index)];
      if (place.patch < 0) {
        place = expected;
        queue.push_back(there.saddle_index);
      } else if (std::tie(place.column, place.row, place.turn) != std::tie(expected.column, expected.row, expected.turn)) {
        contradicted.push_back(there.saddle_index);
      }
    }
  }
  members.erase(std::remove_if(members.begin(), members.end(),
                               [&contradicted](int i) {
                                 return std::find(contradicted.begin(), contradicted.end(), i) != contradicted.end();
                               }),
                members.end());
  return members;
}

/// Moves the places to start at 0. Of saddles that claim one place none is kept.
SaddleLattice latticeOf(const std::vector<int>& members, const std::vector<Place>& places) {
  int min_column = std::numeric_limits<int>::max();
  int min_row = std::numeric_limits<int>::max();
  for (const int i : members) {
    min_column = std::min(min_column, places[static_cast<std::size_t>(i)].column);
    min_row = std::min(min_row, places[static_cast<std::size_t>(i)].row);
  }
  std::vector<LatticeNode> nodes;
  for (const int i : members) {
    const Place& place = places[static_cast<std::size_t>(i)];
    nodes.push_back({place.column - min_column, place.row - min_row, i});
  }
  const auto same_place = [](const LatticeNode& a, const LatticeNode& b) { return a.row == b.row && a.column == b.column; };
  std::sort(nodes.begin(), nodes.end(), [](const LatticeNode& a, const LatticeNode& b) {
    return std::tie(a.row, a.column, a.saddle_index) < std::tie(b.row, b.column, b.saddle_index);
  });
  std::vector<LatticeNode> unique;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const bool shared =
        (i > 0 && same_place(nodes[i - 1], nodes[i])) || (i + 1 < nodes.size() && same_place(nodes[i], nodes[i + 1]));
    if (!shared) {
      unique.push_back(nodes[i]);
    }
  }
  return {std::move(unique), (min_column + min_row) & 1};  // the seed's arm 0 has dark clockwise of it
}

}  // namespace

SaddleLattice::SaddleLattice(std::vector<LatticeNode> nodes, int dark_parity)
    : nodes_(std::move(nodes)), dark_parity_(dark_parity) {
  for (const LatticeNode& node : nodes_) {
    num_columns_ = std::max(num_columns_, node.column + 1);
    num_rows_ = std::max(num_rows_, node.row + 1);
  }
  saddle_at_.assign(static_cast<std::size_t>(num_columns_) * static_cast<std::size_t>(num_rows_), -1);
  for (const LatticeNode& node : nodes_) {
    saddle_at_[static_cast<std::size_t>(node.row * num_columns_ + node.column)] = node.saddle_index;
  }
}

int SaddleLattice::saddleIndexAt(int column, int row) const {
  if (column < 0 || row < 0 || column >= num_columns_ || row >= num_rows_) {
    return -1;
  }
  return saddle_at_[static_cast<std::size_t>(row * num_columns_ + column)];
}

std::vector<SaddleLattice> growLattices(const cv::Mat& gray, const std::vector<Saddle>& saddles) {
  const auto links = linkSaddles(gray, saddles);
  const FaceTable faces(saddles, links);
  std::vector<Place> places(saddles.size());
  std::vector<SaddleLattice> lattices;
  for (int seed = 0; seed < static_cast<int>(saddles.size()); ++seed) {
    bool has_face = false;
    for (int arm = 0; arm < 4; ++arm) {
      has_face = has_face || faces.isClosed({seed, arm});
    }
    if (!has_face || places[static_cast<std::size_t>(seed)].patch >= 0) {
      continue;
    }
    SaddleLattice lattice = latticeOf(growPatch(links, faces, seed, places), places);
    if (lattice.nodes().size() >= 4) {
      lattices.push_back(std::move(lattice));
    }
  }
  std::stable_sort(lattices.begin(), lattices.end(),
                   [](const SaddleLattice& a, const SaddleLattice& b) { return a.nodes().size() > b.nodes().size(); });
  return lattices;
}

}  // namespace tartan_calib::detection
