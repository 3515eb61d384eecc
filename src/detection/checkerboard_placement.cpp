#include "checkerboard_placement.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <optional>

namespace tartan_calib::detection {
namespace {

// An outer line of the lattice with a smaller share of corners than the fullest line is a chance find beyond the board.
constexpr double kMinLineFill_ratio = 0.5;
// A lattice with a smaller share of corners says nothing about the size of a board.
constexpr double kMinBoardFill_ratio = 0.9;

// Error of the prediction of a corner from its neighbours [squares] that three quarters of the corners must stay below.
// Boards of 6x5 corners and more at the rim of a lens of 195 degrees have up to 0.06, letters 0.27 and more; boards of 5x4
// that fill half of such an image have up to 0.21.
constexpr double kMaxPredictionErrorSquares = 0.22;
constexpr double kRegularShare = 0.75;

/// Columns and rows of a lattice, the first inclusive, the last exclusive.
struct Extent {
  int first_column, last_column, first_row, last_row;

  int columns() const { return last_column - first_column; }
  int rows() const { return last_row - first_row; }
};

/// Number of corners in each column or row.
std::vector<int> lineCounts(const SaddleLattice& lattice, const Extent& extent, bool of_columns) {
  std::vector<int> counts(static_cast<std::size_t>(of_columns ? lattice.numColumns() : lattice.numRows()), 0);
  for (const LatticeNode& node : lattice.nodes()) {
    if (node.column >= extent.first_column && node.column < extent.last_column && node.row >= extent.first_row &&
        node.row < extent.last_row) {
      ++counts[static_cast<std::size_t>(of_columns ? node.column : node.row)];
    }
  }
  return counts;
}

/// Shrinks [first, last) past outer lines that are nearly empty; true if it did.
bool trimLines(const std::vector<int>& counts, int& first, int& last) {
  const double min_count = kMinLineFill_ratio * *std::max_element(counts.begin(), counts.end());
  const int previous_size = last - first;
  while (first < last && counts[static_cast<std::size_t>(first)] < min_count) {
    ++first;
  }
  while (first < last && counts[static_cast<std::size_t>(last - 1)] < min_count) {
    --last;
  }
  return last - first < previous_size;
}

Extent filledExtent(const SaddleLattice& lattice) {
  Extent extent{0, lattice.numColumns(), 0, lattice.numRows()};
  bool trimmed = true;
  while (trimmed) {
    trimmed = trimLines(lineCounts(lattice, extent, true), extent.first_column, extent.last_column);
    trimmed = trimLines(lineCounts(lattice, extent, false), extent.first_row, extent.last_row) || trimmed;
  }
  return extent;
}

/// A way to lay the board on the lattice: `quarter_turns` clockwise.
struct Placement {
  Extent extent;
  int quarter_turns;

  /// Place on the board, counted from corner 0 of the board as it is turned.
  LatticePlace onBoard(int column, int row) const {
    const int right = column - extent.first_column;
    const int left = extent.last_column - 1 - column;
    const int down = row - extent.first_row;
    const int up = extent.last_row - 1 - row;
    const std::array<LatticePlace, 4> turns{LatticePlace{down, right}, LatticePlace{left, down}, LatticePlace{up, left},
                                            LatticePlace{right, up}};
    return turns[static_cast<std::size_t>(quarter_turns)];
  }

  /// Whether the square beyond corner 0 of the board is dark.
  bool isDarkAtOrigin(const SaddleLattice& lattice) const {
    const bool at_last_column = quarter_turns == 1 || quarter_turns == 2;
    const bool at_last_row = quarter_turns == 2 || quarter_turns == 3;
    return lattice.isDarkFace(at_last_column ? extent.last_column - 1 : extent.first_column - 1,
                              at_last_row ? extent.last_row - 1 : extent.first_row - 1);
  }

  PlacedCorners corners(const SaddleLattice& lattice, const std::vector<Saddle>& saddles) const {
    PlacedCorners placed;
    placed.dark_ahead = isDarkAtOrigin(lattice);  // squares that touch at a corner are alike
    for (const LatticeNode& node : lattice.nodes()) {
      const bool inside = node.column >= extent.first_column && node.column < extent.last_column &&
                          node.row >= extent.first_row && node.row < extent.last_row;
      if (inside) {
        placed.saddles.emplace(onBoard(node.column, node.row), saddles[static_cast<std::size_t>(node.saddle_index)]);
      }
    }
    return placed;
  }
};

/// How far rows and columns run towards the lower right of the image: the covariance of row + column with u + v.
double towardsLowerRight(const PlacedCorners& corners) {
  double sum_place = 0.0;
  double sum_px = 0.0;
  double sum_product = 0.0;
  for (const auto& [place, saddle] : corners.saddles) {
    sum_place += place.first + place.second;
    sum_px += saddle.px.sum();
    sum_product += (place.first + place.second) * saddle.px.sum();
  }
  return sum_product - sum_place * sum_px / static_cast<double>(corners.saddles.size());
}

}  // namespace

std::optional<PlacedCorners> placeOnBoard(const SaddleLattice& lattice, const std::vector<Saddle>& saddles,
                                          const target::Checkerboard& board) {
  const Extent extent = filledExtent(lattice);
  std::vector<Placement> placements;
  for (int quarter_turns = 0; quarter_turns < 4; ++quarter_turns) {
    const bool upright = quarter_turns % 2 == 0;
    if ((upright ? extent.rows() : extent.columns()) == board.rows &&
        (upright ? extent.columns() : extent.rows()) == board.cols) {
      placements.push_back({extent, quarter_turns});
    }
  }
  const auto dark_end = std::stable_partition(placements.begin(), placements.end(),
                                              [&](const Placement& p) { return p.isDarkAtOrigin(lattice); });
  if (dark_end != placements.begin()) {
    placements.erase(dark_end, placements.end());
  }
  std::optional<PlacedCorners> best;
  for (const Placement& placement : placements) {
    PlacedCorners corners = placement.corners(lattice, saddles);
    if (!best || towardsLowerRight(corners) > towardsLowerRight(*best)) {
      best = std::move(corners);
    }
  }
  return best;
}

bool isRegular(const SaddleLattice& lattice, const std::vector<Saddle>& saddles) {
  std::map<LatticePlace, Eigen::Vector2d> corners_px;
  for (const LatticeNode& node : lattice.nodes()) {
    corners_px[{node.row, node.column}] = saddles[static_cast<std::size_t>(node.saddle_index)].px;
  }
  std::ptrdiff_t num_regular = 0;
  std::ptrdiff_t num_predicted = 0;
  for (const auto& [place, px] : corners_px) {
    if (const std::optional<LatticeMap> map = fitLatticeMap(corners_px, place, false)) {
      ++num_predicted;
      num_regular += (map->centre_px() - px).norm() < kMaxPredictionErrorSquares * map->minSpacing_px() ? 1 : 0;
    }
  }
  return static_cast<double>(num_regular) >= kRegularShare * static_cast<double>(num_predicted);
}

std::optional<BoardSize> shownSize(const SaddleLattice& lattice) {
  const Extent extent = filledExtent(lattice);
  const std::vector<int> counts = lineCounts(lattice, extent, true);
  const int num_corners = std::accumulate(counts.begin(), counts.end(), 0);
  if (num_corners < kMinBoardFill_ratio * extent.columns() * extent.rows()) {
    return std::nullopt;
  }
  return BoardSize(std::minmax(extent.columns(), extent.rows()));
}

}  // namespace tartan_calib::detection
