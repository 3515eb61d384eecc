#include "tartan_calib/io/target_yaml.h"

#include <functional>
#include <map>
#include <set>

#include "read_file.h"
#include "tartan_calib/error.h"
#include "tartan_calib/target/tag_family.h"
#include "yaml_reader.h"

namespace tartan_calib::io {
namespace {

constexpr const char* kReader = "[CalibrationTargetConfig Reader]: ";
constexpr int kMinGrid = 3;  ///< Kalibr's rule for rows and columns
/// Far beyond any board; a larger number is a slip that would only fill the memory.
constexpr int kMaxGrid = 1000;
constexpr int kMaxBorderCells = 2;

/// Reads one target's keys, and remembers them to find those that nothing reads.
class Reader {
 public:
  Reader(const YAML::Node& map, const std::string& name) : map_(map), name_(name), known_{"target_type"} {}

  int gridSize(const std::string& key) {
    return ranged(key, required(key), kMinGrid, kMaxGrid, "int>=" + std::to_string(kMinGrid));
  }

  int optionalInt(const std::string& key, int fallback, int min, int max, const std::string& expected) {
    const YAML::Node node = find(key);
    return node.IsDefined() ? ranged(key, node, min, max, expected) : fallback;
  }

  double positive(const std::string& key) {
    const YAML::Node node = required(key);
    const std::optional<double> value = yamlNumber(node);
    if (!value || *value <= 0.0) {
      reject(key, node, "float>0");
    }
    return *value;
  }

  bool flag(const std::string& key) {
    const YAML::Node node = required(key);
    const std::optional<bool> value = yamlBool(node);
    if (!value) {
      reject(key, node, "bool");
    }
    return *value;
  }

  std::string optionalText(const std::string& key, const std::string& fallback) {
    const YAML::Node node = find(key);
    if (!node.IsDefined()) {
      return fallback;
    }
    const std::optional<std::string> value = yamlText(node);
    if (!value) {
      reject(key, node, "text");
    }
    return *value;
  }

  [[noreturn]] void reject(const std::string& key, const std::string& expected) const {
    reject(key, map_[key], expected, yamlExcerpt(map_[key]));
  }

  std::vector<std::string> unknownKeys() const {
    std::vector<std::string> warnings;
    for (const auto& entry : map_) {
      const std::string key = entry.first.IsScalar() ? entry.first.Scalar() : yamlExcerpt(entry.first);
      if (known_.count(key) == 0) {
        warnings.push_back(yamlPlace(name_, entry.first) + ": unknown key '" + key + "' has no effect; known are " +
                           knownList());
      }
    }
    return warnings;
  }

 private:
  YAML::Node find(const std::string& key) {
    known_.insert(key);
    return map_[key];
  }

  YAML::Node required(const std::string& key) {
    const YAML::Node node = find(key);
    if (!node.IsDefined()) {
      throw InputError(kReader + std::string("Calibration target configuration in ") + name_ + " is missing the field: '" +
                       key + "'");
    }
    return node;
  }

  int ranged(const std::string& key, const YAML::Node& node, int min, int max, const std::string& expected) const {
    const std::optional<int> value = yamlInt(node);
    if (!value || *value < min || *value > max) {
      reject(key, node, expected);
    }
    return *value;
  }

  /// For values that are no text.
  [[noreturn]] void reject(const std::string& key, const YAML::Node& node, const std::string& expected) const {
    const std::string found = yamlExcerpt(node);
    reject(key, node, expected, isYamlQuoted(node) ? found + " in quotes, which make it text: leave them out" : found);
  }

  [[noreturn]] void reject(const std::string& key, const YAML::Node& node, const std::string& expected,
                           const std::string& found) const {
    throw InputError(kReader + std::string("invalid ") + key + " (" + expected + ") in " + yamlPlace(name_, node) +
                     ": it is " + found);
  }

  std::string knownList() const {
    std::string list;
    for (const std::string& key : known_) {
      list += (list.empty() ? "" : ", ") + key;
    }
    return list;
  }

  const YAML::Node map_;
  const std::string name_;
  std::set<std::string> known_;
};

target::Target readAprilGrid(Reader& reader) {
  target::AprilGrid grid;
  grid.tag_cols = reader.gridSize("tagCols");
  grid.tag_rows = reader.gridSize("tagRows");
  grid.tag_size_m = reader.positive("tagSize");
  grid.tag_spacing_ratio = reader.positive("tagSpacing");
  grid.family = reader.optionalText("tagFamily", grid.family);
  const std::vector<std::string> families = target::tagFamilyNames();
  if (std::find(families.begin(), families.end(), grid.family) == families.end()) {
    std::string list;
    for (const std::string& family : families) {
      list += (list.empty() ? "" : ", ") + family;
    }
    reader.reject("tagFamily", "one of " + list);
  }
  const int num_codes = static_cast<int>(target::tagFamily(grid.family).codes.size());
  const std::string board =
      std::to_string(target::numTags(grid)) + " tags, " + grid.family + " has " + std::to_string(num_codes) + " codes";
  if (target::numTags(grid) > num_codes) {
    reader.reject("tagRows", "the board has " + board);
  }
  const int max_offset = num_codes - target::numTags(grid);
  grid.code_offset = reader.optionalInt("codeOffset", grid.code_offset, 0, max_offset,
                                        "int from 0 to " + std::to_string(max_offset) + ", the board has " + board);
  grid.border_cells = reader.optionalInt("tagBorder", grid.border_cells, 1, kMaxBorderCells,
                                         "cells: 2 as Kalibr prints, 1 as stock AprilTag prints");
  return grid;
}

target::Target readCheckerboard(Reader& reader) {
  target::Checkerboard board;
  board.cols = reader.gridSize("targetCols");
  board.rows = reader.gridSize("targetRows");
  board.row_spacing_m = reader.positive("rowSpacingMeters");
  board.col_spacing_m = reader.positive("colSpacingMeters");
  return board;
}

target::Target readCircleGrid(Reader& reader) {
  target::CircleGrid grid;
  grid.cols = reader.gridSize("targetCols");
  grid.rows = reader.gridSize("targetRows");
  grid.spacing_m = reader.positive("spacingMeters");
  grid.asymmetric = reader.flag("asymmetricGrid");
  return grid;
}

}  // namespace

LoadedTarget parseTarget(const std::string& text, const std::string& name) {
  YAML::Node map;
  try {
    map = parseYamlMap(text, name);
  } catch (const InputError& error) {
    throw InputError(kReader + std::string("Could not read configuration from ") + error.what());
  }
  const std::optional<std::string> type = yamlText(map["target_type"]);
  if (!type) {
    throw InputError(kReader + std::string("Field 'target_type' missing in file: ") + name);
  }
  static const std::map<std::string, std::function<target::Target(Reader&)>> readers = {
      {"aprilgrid", readAprilGrid}, {"checkerboard", readCheckerboard}, {"circlegrid", readCircleGrid}};
  const auto found = readers.find(*type);
  if (found == readers.end()) {
    throw InputError(kReader + std::string("Unknown calibration target type. Supported types: ['aprilgrid', ") +
                     "'checkerboard', 'circlegrid']. target_type in " + name + " is '" + *type + "'");
  }
  Reader reader(map, name);
  LoadedTarget loaded;
  loaded.target = found->second(reader);
  loaded.warnings = reader.unknownKeys();
  return loaded;
}

LoadedTarget loadTarget(const std::string& path) {
  std::string text;
  try {
    text = readFile(path);
  } catch (const InputError& error) {
    throw InputError(kReader + std::string("Could not read configuration from ") + path + ": " + error.what());
  }
  return parseTarget(text, path);
}

}  // namespace tartan_calib::io
