#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <optional>
#include <vector>

#include "tag_map.h"
#include "tartan_calib/target/tag_family.h"

namespace tartan_calib::detection {

/// The payload of a square that may be a tag, row by row from uv = (0, 0); bits as in target::TagFamily. Blur mixes
/// neighbouring cells, so there are several readings, each sharpened more than the one before.
struct TagReading {
  std::vector<std::uint64_t> codes;
  std::vector<double> cells;  ///< as sampled, row by row: about -1 = as dark as the border, 1 = as light as the gap
};

/// A code of the family found in a reading.
struct TagMatch {
  int tag_id = -1;
  int top_left = 0;  ///< which corner of the TagMap (0 .. 3, clockwise) is the printed tag's top left one
  int hamming = 0;
};

/// Reads and recognises the tags of one family.
class TagReader {
 public:
  explicit TagReader(target::TagFamily family) : family_(std::move(family)) {}

  const target::TagFamily& family() const { return family_; }

  /// Samples the cells through the map; nothing where the square is not dark with a dark border of `border_cells`.
  /// `gap` is the width of the white between tags [tag sides].
  std::optional<TagReading> read(const cv::Mat& gray, const TagMap& map, int border_cells, double gap) const;

  /// The nearest code of the family; nothing if it has more than `max_hamming` wrong bits.
  std::optional<TagMatch> match(const TagReading& reading, int max_hamming) const;

  /// The same for the mirror image of the reading.
  std::optional<TagMatch> matchMirrored(const TagReading& reading, int max_hamming) const;

  /// Wrong bits of the reading, if it is tag `tag_id` with that top left corner.
  int hammingTo(const TagReading& reading, int tag_id, int top_left) const;

 private:
  std::uint64_t turned(std::uint64_t code) const;
  std::uint64_t mirrored(std::uint64_t code) const;

  target::TagFamily family_;
};

}  // namespace tartan_calib::detection
