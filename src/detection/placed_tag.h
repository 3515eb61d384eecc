#pragma once

#include <array>
#include <opencv2/core.hpp>
#include <optional>
#include <vector>

#include "payload_patterns.h"
#include "tag_map.h"
#include "tag_reader.h"
#include "tartan_calib/detection/saddle.h"
#include "tartan_calib/detection/target_detector.h"
#include "tartan_calib/target/target.h"

namespace tartan_calib::detection {

/// What the search for tags looks at, and what for.
struct BoardSearch {
  const cv::Mat& gray;
  const std::vector<Saddle>& saddles;
  const target::AprilGrid& grid;
  const TagReader& reader;
  const PayloadPatterns& patterns;
  int max_hamming;
};

/// A tag of the board in the image. Corners are clockwise from the printed tag's top left one; `map` has uv = (0, 0) there,
/// u to the right and v down as printed.
struct PlacedTag {
  int tag_index = -1;
  std::array<int, 4> saddle_index;            ///< -1 for a corner that is hidden; at most one is
  std::array<Eigen::Vector2d, 4> corners_px;  ///< of the saddles, or where the hidden corner should be
  TagMap map;
};

/// True if a reading agrees with the tag that other tags say must be there. Up to half of the distance between codes it
/// cannot be taken for another; beyond that, blurred cells must look like the tag's.
inline bool agreesWithPlace(const BoardSearch& search, const TagReading& reading, int tag_index, int top_left) {
  constexpr double kMinCorrelation = 0.6;
  const int max_hamming = (search.reader.family().min_hamming_distance - 1) / 2;
  return search.reader.hammingTo(reading, search.grid.code_offset + tag_index, top_left) <= max_hamming ||
         search.patterns.correlation(reading.cells, tag_index, top_left) >= kMinCorrelation;
}

/// Map of a square of a lattice, its corners (0, 0), (1, 0), (1, 1), (0, 1), bent towards the nodes around it.
/// `pixel_at(i, j)`, i and j from -1 to 2, gives the pixel of such a node or nothing.
template <typename PixelAt>
TagMap bentMap(double gap, const std::array<Eigen::Vector2d, 4>& corners_px, const PixelAt& pixel_at) {
  TagMap map(corners_px);
  const std::array<double, 4> position = {-gap, 0.0, 1.0, 1.0 + gap};
  std::vector<TagPoint> around;
  for (int j = -1; j <= 2; ++j) {
    for (int i = -1; i <= 2; ++i) {
      const bool is_corner = (i == 0 || i == 1) && (j == 0 || j == 1);
      const std::optional<Eigen::Vector2d> px = is_corner ? std::nullopt : std::optional<Eigen::Vector2d>(pixel_at(i, j));
      if (px) {
        around.push_back({{position[static_cast<std::size_t>(i + 1)], position[static_cast<std::size_t>(j + 1)]}, *px});
      }
    }
  }
  map.bendTowards(around);
  return map;
}

}  // namespace tartan_calib::detection
