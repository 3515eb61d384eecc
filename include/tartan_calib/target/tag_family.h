#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace tartan_calib::target {

/// The codes of an AprilTag family, independent of the width of the border around them.
struct TagFamily {
  std::string name;               ///< as Kalibr and this tool write it: t36h11
  int payload_cells = 6;          ///< the payload is payload_cells x payload_cells
  int min_hamming_distance = 11;  ///< between any two codes, in any rotation
  /// codes[id]: bit (payload_cells^2 - 1 - k) is the k-th cell, row-major from the top left of the tag as printed; 1 =
  /// white.
  std::vector<std::uint64_t> codes;
};

/// Names that tagFamily accepts.
std::vector<std::string> tagFamilyNames();

/// The family's table, taken from libapriltag once. Throws InputError that lists the known names.
const TagFamily& tagFamily(const std::string& name);

/// True where cell (row, col), counted from the top left of the payload as printed, is white.
bool isWhiteCell(const TagFamily& family, int tag_id, int row, int col);

}  // namespace tartan_calib::target
