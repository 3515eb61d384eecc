#include "lattice_tags.h"

#include <algorithm>
#include <cmath>

#include "board_placement.h"

namespace tartan_calib::detection {
namespace {

/// A dark face of a lattice with its payload.
struct Face {
  int column;
  int row;
  std::array<int, 4> saddle_index;  ///< clockwise from the node (column, row)
  TagMap map;
  std::optional<TagReading> reading;
  std::optional<TagMatch> match;
  bool has_other_border = false;  ///< a tag, but with the other border width; reading and match are empty then
};

std::optional<std::array<int, 4>> faceCorners(const SaddleLattice& lattice, int column, int row) {
  const std::array<int, 4> corners = {lattice.saddleIndexAt(column, row), lattice.saddleIndexAt(column + 1, row),
                                      lattice.saddleIndexAt(column + 1, row + 1), lattice.saddleIndexAt(column, row + 1)};
  const bool complete = std::all_of(corners.begin(), corners.end(), [](int i) { return i >= 0; });
  return complete ? std::optional<std::array<int, 4>>(corners) : std::nullopt;
}

std::array<Eigen::Vector2d, 4> pixelsOf(const BoardSearch& search, const std::array<int, 4>& saddles) {
  std::array<Eigen::Vector2d, 4> px;
  for (std::size_t k = 0; k < 4; ++k) {
    px[k] = search.saddles[static_cast<std::size_t>(saddles[k])].px;
  }
  return px;
}

/// With the wrong border the cells are sampled askew, which may leave few wrong bits: the border with fewer is the right
/// one.
void readFace(const BoardSearch& search, Face& face) {
  const double gap = search.grid.tag_spacing_ratio;
  face.reading = search.reader.read(search.gray, face.map, search.grid.border_cells, gap);
  face.match = face.reading ? search.reader.match(*face.reading, search.max_hamming) : std::nullopt;
  if (face.match && face.match->hamming == 0) {
    return;
  }
  const int other_border = search.grid.border_cells == 1 ? 2 : 1;
  const auto other_reading = search.reader.read(search.gray, face.map, other_border, gap);
  const int max_hamming = face.match ? face.match->hamming - 1 : search.max_hamming;
  face.has_other_border = other_reading && search.reader.match(*other_reading, max_hamming);
  if (face.has_other_border) {
    face.reading.reset();
    face.match.reset();
  }
}

std::vector<Face> readDarkFaces(const BoardSearch& search, const SaddleLattice& lattice) {
  std::vector<Face> faces;
  for (const LatticeNode& node : lattice.nodes()) {
    const auto corners = faceCorners(lattice, node.column, node.row);
    if (!corners || !lattice.isDarkFace(node.column, node.row)) {
      continue;
    }
    const auto pixelAt = [&](int i, int j) {
      const int index = lattice.saddleIndexAt(node.column + i, node.row + j);
      return index < 0 ? std::nullopt : std::optional<Eigen::Vector2d>(search.saddles[static_cast<std::size_t>(index)].px);
    };
    Face face{node.column, node.row, *corners, bentMap(search.grid.tag_spacing_ratio, pixelsOf(search, *corners), pixelAt),
              {},          {}};
    readFace(search, face);
    faces.push_back(std::move(face));
  }
  return faces;
}

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

std::optional<PlacementVote> placeOnBoard(const BoardSearch& search, const std::vector<Face>& faces) {
  std::vector<DecodedFace> decoded;
  for (const Face& face : faces) {
    const auto index = face.match ? tagIndexOf(search.grid, face.match->tag_id) : std::nullopt;
    if (index) {
      decoded.push_back({face.column, face.row, *index, face.match->top_left});
    }
  }
  const auto vote = votePlacement(search.grid, decoded);
  return vote && vote->num_votes >= minVotes(search) ? vote : std::nullopt;
}

/// Index of the tag that a face is under a placement; nothing for the squares between tags and beyond the board.
std::optional<int> tagAt(const target::AprilGrid& grid, const BoardPlacement& placement, const Face& face) {
  const Eigen::Vector2i lowest =
      placement.boardCorner(face.column, face.row).cwiseMin(placement.boardCorner(face.column + 1, face.row + 1));
  const bool on_board =
      lowest.x() >= 0 && lowest.y() >= 0 && lowest.x() < 2 * grid.tag_cols && lowest.y() < 2 * grid.tag_rows;
  if (!on_board || lowest.x() % 2 != 0 || lowest.y() % 2 != 0) {
    return std::nullopt;
  }
  return lowest.y() / 2 * grid.tag_cols + lowest.x() / 2;
}

/// True if the face's payload is that of the tag at its place.
bool isTag(const BoardSearch& search, const PlacementVote& vote, const Face& face, int tag_index) {
  if (!face.reading) {
    return false;
  }
  const int hamming = search.reader.hammingTo(*face.reading, search.grid.code_offset + tag_index, vote.placement.topLeft());
  if (hamming <= search.max_hamming) {
    return true;
  }
  constexpr int kSettledVotes = 2;
  return vote.num_votes >= kSettledVotes && hamming <= maxHammingWherePlaced(search.reader.family());
}

PlacedTag placedTag(const BoardSearch& search, const Face& face, int tag_index, int top_left) {
  std::array<int, 4> corners = face.saddle_index;
  std::rotate(corners.begin(), corners.begin() + top_left, corners.end());
  const auto px = pixelsOf(search, corners);
  return {tag_index, corners, px, TagMap(px)};
}

/// Says what a face is that is no tag of the board.
void countOther(const BoardSearch& search, const Face& face, DetectionCounts& counts) {
  if (face.match) {
    ++counts.foreign_tags;
  } else if (face.has_other_border) {
    ++counts.other_border_tags;
  } else if (face.reading && search.reader.matchMirrored(*face.reading, search.max_hamming)) {
    ++counts.mirrored_tags;
  }
}

}  // namespace

std::vector<PlacedTag> findLatticeTags(const BoardSearch& search, const SaddleLattice& lattice, DetectionCounts& counts) {
  auto faces = readDarkFaces(search, lattice);
  auto vote = placeOnBoard(search, faces);
  const auto num_other = std::count_if(faces.begin(), faces.end(), [](const Face& face) { return face.has_other_border; });
  if (vote && num_other > vote->num_votes) {  // by chance some codes survive the askew sampling
    vote.reset();
    for (Face& face : faces) {
      face.has_other_border = face.has_other_border || face.match;
      face.match.reset();
    }
  }
  std::vector<PlacedTag> tags;
  for (const Face& face : faces) {
    const auto tag_index = vote ? tagAt(search.grid, vote->placement, face) : std::nullopt;
    if (tag_index && isTag(search, *vote, face, *tag_index)) {
      tags.push_back(placedTag(search, face, *tag_index, vote->placement.topLeft()));
    } else {
      countOther(search, face, counts);
    }
  }
  return tags;
}

}  // namespace tartan_calib::detection
