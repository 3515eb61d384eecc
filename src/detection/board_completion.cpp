#include "board_completion.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace tartan_calib::detection {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kSearchRadius = 0.15;  ///< around a predicted corner [tag sides]; the nearest other corner is a gap away
constexpr double kMinSearchRadius_px = 2.0;
constexpr int kMinSeenCorners = 3;

/// The tags found so far, by their place on the board.
class TagTable {
 public:
  TagTable(const target::AprilGrid& grid, const std::vector<PlacedTag>& tags)
      : grid_(grid), tags_(tags), at_(static_cast<std::size_t>(target::numTags(grid)), -1) {
    for (std::size_t i = 0; i < tags.size(); ++i) {
      at_[static_cast<std::size_t>(tags[i].tag_index)] = static_cast<int>(i);
    }
  }

  const PlacedTag* find(int row, int col) const {
    if (row < 0 || col < 0 || row >= grid_.tag_rows || col >= grid_.tag_cols) {
      return nullptr;
    }
    const int i = at_[static_cast<std::size_t>(row * grid_.tag_cols + col)];
    return i < 0 ? nullptr : &tags_[static_cast<std::size_t>(i)];
  }

 private:
  const target::AprilGrid& grid_;
  const std::vector<PlacedTag>& tags_;
  std::vector<int> at_;
};

const std::array<Eigen::Vector2d, 4>& unitSquare() {
  static const std::array<Eigen::Vector2d, 4> corners = {Eigen::Vector2d(0, 0), Eigen::Vector2d(1, 0), Eigen::Vector2d(1, 1),
                                                         Eigen::Vector2d(0, 1)};
  return corners;
}

/// Where the corners of the tag at (row, col) should be, by the mean of what its neighbours say.
std::optional<std::array<Eigen::Vector2d, 4>> predictCorners(const BoardSearch& search, const TagTable& table, int row,
                                                             int col) {
  std::array<Eigen::Vector2d, 4> sum;
  sum.fill(Eigen::Vector2d::Zero());
  int num_neighbours = 0;
  for (const Eigen::Vector2i& step :
       {Eigen::Vector2i(1, 0), Eigen::Vector2i(-1, 0), Eigen::Vector2i(0, 1), Eigen::Vector2i(0, -1)}) {
    const PlacedTag* neighbour = table.find(row + step.y(), col + step.x());
    if (neighbour == nullptr) {
      continue;
    }
    // As printed, u goes right with the columns and v down against the rows.
    const Eigen::Vector2d shift = (1.0 + search.grid.tag_spacing_ratio) * Eigen::Vector2d(-step.x(), step.y());
    for (std::size_t k = 0; k < 4; ++k) {
      sum[k] += neighbour->map(shift + unitSquare()[k]);
    }
    ++num_neighbours;
  }
  if (num_neighbours == 0) {
    return std::nullopt;
  }
  for (Eigen::Vector2d& px : sum) {
    px /= num_neighbours;
  }
  return sum;
}

/// True if the direction from the saddle to `px` lies in one of its dark wedges.
bool isDarkTowards(const Saddle& saddle, const Eigen::Vector2d& px) {
  const Eigen::Vector2d d = px - saddle.px;
  const double from_first_rad = std::atan2(d.y(), d.x()) - saddle.arm_rad[0];
  const double angle_rad = from_first_rad - 2.0 * kPi * std::floor(from_first_rad / (2.0 * kPi));
  const double wedge_end_rad = saddle.arm_rad[1] - saddle.arm_rad[0];
  const double opposite_rad = saddle.arm_rad[2] - saddle.arm_rad[0];
  const double opposite_end_rad = saddle.arm_rad[3] - saddle.arm_rad[0];
  return angle_rad < wedge_end_rad || (angle_rad > opposite_rad && angle_rad < opposite_end_rad);
}

int nearestSaddle(const BoardSearch& search, const Eigen::Vector2d& px, const Eigen::Vector2d& tag_centre,
                  double radius_px) {
  int best = -1;
  double best_distance_px = radius_px;
  for (std::size_t i = 0; i < search.saddles.size(); ++i) {
    const double distance_px = (search.saddles[i].px - px).norm();
    if (distance_px < best_distance_px && isDarkTowards(search.saddles[i], tag_centre)) {
      best = static_cast<int>(i);
      best_distance_px = distance_px;
    }
  }
  return best;
}

double areaOf(const std::array<Eigen::Vector2d, 4>& corners) {
  const Eigen::Vector2d a = corners[2] - corners[0];
  const Eigen::Vector2d b = corners[3] - corners[1];
  return 0.5 * std::abs(a.x() * b.y() - a.y() * b.x());
}

/// Saddles at the predicted corners. A corner that has none stays at its prediction, moved as the others were.
std::optional<PlacedTag> matchCorners(const BoardSearch& search, const std::array<Eigen::Vector2d, 4>& predicted_px,
                                      int tag_index) {
  const Eigen::Vector2d centre = 0.25 * (predicted_px[0] + predicted_px[1] + predicted_px[2] + predicted_px[3]);
  const double radius_px = std::max(kMinSearchRadius_px, kSearchRadius * std::sqrt(areaOf(predicted_px)));
  PlacedTag tag{tag_index, {}, predicted_px, TagMap(predicted_px)};
  Eigen::Vector2d shift_sum = Eigen::Vector2d::Zero();
  int num_seen = 0;
  for (std::size_t k = 0; k < 4; ++k) {
    tag.saddle_index[k] = nearestSaddle(search, predicted_px[k], centre, radius_px);
    if (tag.saddle_index[k] >= 0) {
      tag.corners_px[k] = search.saddles[static_cast<std::size_t>(tag.saddle_index[k])].px;
      shift_sum += tag.corners_px[k] - predicted_px[k];
      ++num_seen;
    }
  }
  if (num_seen < kMinSeenCorners) {
    return std::nullopt;
  }
  for (std::size_t k = 0; k < 4; ++k) {
    if (tag.saddle_index[k] < 0) {
      tag.corners_px[k] += shift_sum / num_seen;
    }
  }
  tag.map = TagMap(tag.corners_px);
  return tag;
}

/// The missing tag, if its payload can be read between saddles at its predicted corners.
std::optional<PlacedTag> seekTag(const BoardSearch& search, const std::array<Eigen::Vector2d, 4>& predicted_px,
                                 int tag_index) {
  const auto tag = matchCorners(search, predicted_px, tag_index);
  if (!tag) {
    return std::nullopt;
  }
  const auto reading = search.reader.read(search.gray, tag->map, search.grid.border_cells, search.grid.tag_spacing_ratio);
  constexpr int kTopLeft = 0;
  const bool is_tag = reading && agreesWithPlace(search, *reading, tag_index, kTopLeft);
  return is_tag ? tag : std::nullopt;
}

/// One round over the missing tags; true if any was found.
bool addNeighbours(const BoardSearch& search, const std::set<int>& excluded, std::vector<PlacedTag>& tags) {
  std::vector<PlacedTag> added;
  const TagTable table(search.grid, tags);
  for (int row = 0; row < search.grid.tag_rows; ++row) {
    for (int col = 0; col < search.grid.tag_cols; ++col) {
      const int tag_index = row * search.grid.tag_cols + col;
      if (table.find(row, col) != nullptr || excluded.count(tag_index) != 0) {
        continue;
      }
      const auto predicted_px = predictCorners(search, table, row, col);
      const auto tag = predicted_px ? seekTag(search, *predicted_px, tag_index) : std::nullopt;
      if (tag) {
        added.push_back(*tag);
      }
    }
  }
  tags.insert(tags.end(), added.begin(), added.end());
  return !added.empty();
}

}  // namespace

void completeBoard(const BoardSearch& search, const std::set<int>& excluded, std::vector<PlacedTag>& tags) {
  bendMaps(search, tags);
  while (addNeighbours(search, excluded, tags)) {
    bendMaps(search, tags);
  }
}

void bendMaps(const BoardSearch& search, std::vector<PlacedTag>& tags) {
  const TagTable table(search.grid, tags);
  std::vector<TagMap> maps;
  for (const PlacedTag& tag : tags) {
    const int row = tag.tag_index / search.grid.tag_cols;
    const int col = tag.tag_index % search.grid.tag_cols;
    // Nodes i, j = -1 and 2 belong to the neighbours; as printed, j goes down.
    const auto pixel_at = [&](int i, int j) -> std::optional<Eigen::Vector2d> {
      const int col_step = i < 0 ? -1 : i / 2;
      const int row_step = j < 0 ? 1 : -(j / 2);
      const PlacedTag* owner = table.find(row + row_step, col + col_step);
      if (owner == nullptr) {
        return std::nullopt;
      }
      const bool right = i == -1 || i == 1;
      const bool bottom = j == -1 || j == 1;
      const std::size_t corner = bottom ? (right ? 2U : 3U) : (right ? 1U : 0U);
      return owner->saddle_index[corner] < 0 ? std::nullopt : std::optional<Eigen::Vector2d>(owner->corners_px[corner]);
    };
    maps.push_back(bentMap(search.grid.tag_spacing_ratio, tag.corners_px, pixel_at));
  }
  for (std::size_t i = 0; i < tags.size(); ++i) {
    tags[i].map = maps[i];
  }
}

}  // namespace tartan_calib::detection
