#include "lattice_tags.h"

#include <algorithm>

#include "tag_face.h"

namespace tartan_calib::detection {
namespace {

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
void readFace(const BoardSearch& search, TagFace& face) {
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

std::vector<TagFace> readDarkFaces(const BoardSearch& search, const SaddleLattice& lattice) {
  std::vector<TagFace> faces;
  for (const LatticeNode& node : lattice.nodes()) {
    const auto corners = faceCorners(lattice, node.column, node.row);
    if (!corners || !lattice.isDarkFace(node.column, node.row)) {
      continue;
    }
    const auto pixel_at = [&](int i, int j) {
      const int index = lattice.saddleIndexAt(node.column + i, node.row + j);
      return index < 0 ? std::nullopt : std::optional<Eigen::Vector2d>(search.saddles[static_cast<std::size_t>(index)].px);
    };
    TagFace face{node.column, node.row,
                 *corners,    bentMap(search.grid.tag_spacing_ratio, pixelsOf(search, *corners), pixel_at),
                 {},          {}};
    readFace(search, face);
    faces.push_back(std::move(face));
  }
  return faces;
}

/// True if the face's payload is that of the tag at its place.
bool isTag(const BoardSearch& search, const PlacementVote& vote, const TagFace& face, int tag_index) {
  if (!face.reading) {
    return false;
  }
  const int top_left = vote.placement.topLeft();
  if (search.reader.hammingTo(*face.reading, search.grid.code_offset + tag_index, top_left) <= search.max_hamming) {
    return true;
  }
  constexpr int kSettledVotes = 2;
  return !face.match && vote.num_votes >= kSettledVotes && agreesWithPlace(search, *face.reading, tag_index, top_left);
}

PlacedTag placedTag(const BoardSearch& search, const TagFace& face, int tag_index, int top_left) {
  std::array<int, 4> corners = face.saddle_index;
  std::rotate(corners.begin(), corners.begin() + top_left, corners.end());
  const auto px = pixelsOf(search, corners);
  return {tag_index, corners, px, TagMap(px)};
}

/// Says what a face is that is no tag of the board.
void countOther(const BoardSearch& search, const TagFace& face, DetectionCounts& counts) {
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
  auto vote = placeByVotes(search, faces);
  if (const auto size = otherSize(search, faces, vote)) {
    ++counts.other_sizes[*size];
    return {};
  }
  const auto num_other =
      std::count_if(faces.begin(), faces.end(), [](const TagFace& face) { return face.has_other_border; });
  if (vote && num_other > vote->num_votes) {  // by chance some codes survive the askew sampling
    vote.reset();
    for (TagFace& face : faces) {
      face.has_other_border = face.has_other_border || face.match;
      face.match.reset();
    }
  } else if (!vote && num_other == 0) {
    vote = placeByLooks(search, faces);
  }
  std::vector<PlacedTag> tags;
  for (const TagFace& face : faces) {
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
