#include "tartan_calib/target/tag_family.h"

#include <apriltag/apriltag.h>
#include <apriltag/tag16h5.h>
#include <apriltag/tag25h9.h>
#include <apriltag/tag36h10.h>
#include <apriltag/tag36h11.h>

#include <map>

#include "tartan_calib/error.h"
#include "tartan_calib/text.h"

namespace tartan_calib::target {
namespace {

/// libapriltag orders bits by position tables (a spiral); this reorders them row by row.
std::uint64_t rowMajorCode(const apriltag_family_t& family, std::uint64_t code, int payload_cells) {
  std::uint64_t row_major = 0;
  for (std::uint32_t bit = 0; bit < family.nbits; ++bit) {
    const std::uint64_t white = (code >> (family.nbits - 1U - bit)) & 1U;
    const auto cell = static_cast<unsigned>((static_cast<int>(family.bit_y[bit]) - 1) * payload_cells +
                                            static_cast<int>(family.bit_x[bit]) - 1);
    row_major |= white << (family.nbits - 1U - cell);
  }
  return row_major;
}

TagFamily readFamily(const std::string& name, const apriltag_family_t& table) {
  TagFamily family;
  family.name = name;
  family.payload_cells = table.width_at_border - 2;  // libapriltag's families have a border of one cell
  family.min_hamming_distance = static_cast<int>(table.h);
  for (std::uint32_t id = 0; id < table.ncodes; ++id) {
    family.codes.push_back(rowMajorCode(table, table.codes[id], family.payload_cells));
  }
  return family;
}

/// Families whose payload is a full square inside a black border, as the AprilGrid needs.
const std::map<std::string, TagFamily>& knownFamilies() {
  static const std::map<std::string, TagFamily> families = [] {
    std::map<std::string, TagFamily> read;
    const auto add = [&read](const std::string& name, apriltag_family_t* table, void (*destroy)(apriltag_family_t*)) {
      read[name] = readFamily(name, *table);
      destroy(table);
    };
    add("t16h5", tag16h5_create(), tag16h5_destroy);
    add("t25h9", tag25h9_create(), tag25h9_destroy);
    add("t36h10", tag36h10_create(), tag36h10_destroy);
    add("t36h11", tag36h11_create(), tag36h11_destroy);
    return read;
  }();
  return families;
}

}  // namespace

std::vector<std::string> tagFamilyNames() {
  std::vector<std::string> names;
  for (const auto& entry : knownFamilies()) {
    names.push_back(entry.first);
  }
  return names;
}

const TagFamily& tagFamily(const std::string& name) {
  const auto found = knownFamilies().find(name);
  if (found == knownFamilies().end()) {
    throw InputError("unknown tag family '" + name + "'; known families: " + joined(tagFamilyNames()));
  }
  return found->second;
}

bool isWhiteCell(const TagFamily& family, int tag_id, int row, int col) {
  const int last_bit = family.payload_cells * family.payload_cells - 1;
  const int bit = last_bit - (row * family.payload_cells + col);
  return ((family.codes.at(static_cast<std::size_t>(tag_id)) >> static_cast<unsigned>(bit)) & 1U) != 0U;
}

}  // namespace tartan_calib::target
