#include "tag_face.h"

#include <algorithm>
#include <cmath>

namespace tartan_calib::detection {
namespace {

std::optional<int> tagIndexOf(const target::AprilGrid& grid, int tag_id) {
  const int index = tag_id - grid.code_offset;
  return index >= 0 && index < target::numTags(grid) ? std::optional<int>(index) : std::nullopt;
}

/// How many tags must agree before a lattice is taken for the board. One is enough where chance hardly ever gives a code.
int minVotes(const BoardSearch& search) {
  constexpr double kMaxChance = 1e-5;  // that a random payload is a tag of the board
  const target::TagFamily& family = search.reader.family();
  const int num_bits = family.payload_cells * family.payload_cells;
  double patterns = 0.0;
  double binomial = 1.0;
  for (int wrong = 0; wrong <= search.max_hamming; ++wrong) {
    patterns += binomial;
    binomial *= static_cast<double>(num_bits - wrong) / (wrong + 1);
  }
  const double chance = 4.0 * target::numTags(search.grid) * patterns * std::pow(2.0, -num_bits);
  return chance < kMaxChance ? 1 : 2;
}

/// How well every face looks like every tag in every turn.
class CorrelationTable {
 public:
  CorrelationTable(const BoardSearch& search, const std::vector<const TagFace*>& faces)
      : num_tags_(target::numTags(search.grid)) {
    for (const TagFace* face : faces) {
      for (int i = 0; i < 4 * num_tags_; ++i) {
        values_.push_back(search.patterns.correlation(face->reading->cells, i / 4, i % 4));
      }
    }
  }
  double at(std::size_t face, int tag_index, int top_left) const {
    return values_[face * static_cast<std::size_t>(4 * num_tags_) + static_cast<std::size_t>(4 * tag_index + top_left)];
  }

 private:
  int num_tags_;
  std::vector<double> values_;
};

/// The best placements so far.
struct Ranking {
  std::optional<BoardPlacement> best;
  double best_score = 0.0;
  double second_score = 0.0;  ///< of any other placement

  void add(const BoardPlacement& placement, double score) {
    if (best && placement == *best) {
      return;
    }
    if (score > best_score) {
      second_score = best_score;
      best_score = score;
      best = placement;
    } else {
      second_score = std::max(second_score, score);
    }
  }
};

/// Mean correlation of faces with the tags that they would be; 0 for those that would be none.
double meanCorrelation(const BoardSearch& search, const CorrelationTable& table, const std::vector<const TagFace*>& faces,
                       const BoardPlacement& placement) {
  double sum = 0.0;
  for (std::size_t k = 0; k < faces.size(); ++k) {
    const auto tag_index = tagAt(search.grid, placement, *faces[k]);
    sum += tag_index ? table.at(k, *tag_index, placement.topLeft()) : 0.0;
  }
  return sum / static_cast<double>(faces.size());
}

/// The faces that decoded as tags of a grid.
std::vector<DecodedFace> decodedFaces(const target::AprilGrid& grid, const std::vector<TagFace>& faces) {
  std::vector<DecodedFace> decoded;
  for (const TagFace& face : faces) {
    const auto index = face.match ? tagIndexOf(grid, face.match->tag_id) : std::nullopt;
    if (index) {
      decoded.push_back({face.column, face.row, *index, face.match->top_left});
    }
  }
  return decoded;
}

/// Rows of a grid up to the last one with a face that voted for the placement.
int rowsSeen(const target::AprilGrid& grid, const PlacementVote& vote, const std::vector<DecodedFace>& faces) {
  int rows = 0;
  for (const DecodedFace& face : faces) {
    if (BoardPlacement(grid, face) == vote.placement) {
      rows = std::max(rows, face.tag_index / grid.tag_cols + 1);
    }
  }
  return rows;
}

}  // namespace

std::optional<int> tagAt(const target::AprilGrid& grid, const BoardPlacement& placement, const TagFace& face) {
  const Eigen::Vector2i lowest =
      placement.boardCorner(face.column, face.row).cwiseMin(placement.boardCorner(face.column + 1, face.row + 1));
  const bool on_board =
      lowest.x() >= 0 && lowest.y() >= 0 && lowest.x() < 2 * grid.tag_cols && lowest.y() < 2 * grid.tag_rows;
  if (!on_board || lowest.x() % 2 != 0 || lowest.y() % 2 != 0) {
    return std::nullopt;
  }
  return lowest.y() / 2 * grid.tag_cols + lowest.x() / 2;
}

std::optional<PlacementVote> placeByVotes(const BoardSearch& search, const std::vector<TagFace>& faces) {
  const auto vote = votePlacement(search.grid, decodedFaces(search.grid, faces));
  return vote && vote->num_votes >= minVotes(search) ? vote : std::nullopt;
}

std::optional<BoardSize> otherSize(const BoardSearch& search, const std::vector<TagFace>& faces,
                                   const std::optional<PlacementVote>& vote_on_target) {
  constexpr int kMinLead = 4;  // votes, so that misread tags decide nothing
  const auto num_decoded = std::count_if(faces.begin(), faces.end(), [](const TagFace& f) { return f.match.has_value(); });
  if (num_decoded < kMinLead || (vote_on_target && 2 * vote_on_target->num_votes >= num_decoded)) {
    return std::nullopt;
  }
  target::AprilGrid grid = search.grid;
  const int num_ids = static_cast<int>(search.reader.family().codes.size()) - grid.code_offset;
  int most = 0;
  int second = 0;
  std::optional<BoardSize> size;
  for (grid.tag_cols = 1; grid.tag_cols <= num_ids; ++grid.tag_cols) {
    grid.tag_rows = num_ids / grid.tag_cols;
    const std::vector<DecodedFace> faces_of_grid = decodedFaces(grid, faces);
    const auto vote = votePlacement(grid, faces_of_grid);
    const int num_votes = vote ? vote->num_votes : 0;
    second = std::max(second, std::min(most, num_votes));
    if (num_votes > most) {
      most = num_votes;
      size = BoardSize(rowsSeen(grid, *vote, faces_of_grid), grid.tag_cols);
    }
  }
  const bool is_other = most >= second + kMinLead && size->second != search.grid.tag_cols;
  return is_other ? size : std::nullopt;
}

std::optional<PlacementVote> placeByLooks(const BoardSearch& search, const std::vector<TagFace>& faces) {
  constexpr std::size_t kMinFaces = 4;
  constexpr std::size_t kAnchors = 3;  // faces taken for tags of the board; one would do if none were clutter
  std::vector<const TagFace*> readable;
  for (const TagFace& face : faces) {
    if (face.reading && PayloadPatterns::isPayload(face.reading->cells)) {
      readable.push_back(&face);
    }
  }
  if (readable.size() < kMinFaces) {
    return std::nullopt;
  }
  const CorrelationTable table(search, readable);
  Ranking ranking;
  for (std::size_t anchor = 0; anchor < kAnchors; ++anchor) {
    for (int i = 0; i < 4 * target::numTags(search.grid); ++i) {
      const BoardPlacement placement(search.grid, {readable[anchor]->column, readable[anchor]->row, i / 4, i % 4});
      ranking.add(placement, meanCorrelation(search, table, readable, placement));
    }
  }
  // Chance gives a mean correlation of about 1 / (3 sqrt(faces)), and there are some hundred placements: 5 sigma.
  const double min_score = std::max(0.5, 1.6 / std::sqrt(static_cast<double>(readable.size())));
  constexpr double kMinLead = 0.2;
  if (ranking.best_score < min_score || ranking.best_score - ranking.second_score < kMinLead) {
    return std::nullopt;
  }
  return PlacementVote{*ranking.best, static_cast<int>(readable.size())};
}

}  // namespace tartan_calib::detection
