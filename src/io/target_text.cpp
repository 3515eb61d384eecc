#include "target_text.h"

#include "number_text.h"
#include "tartan_calib/io/target_yaml.h"

namespace tartan_calib::io {
namespace {

struct TargetWriter {
  YamlWriter& yaml;

  void operator()(const target::AprilGrid& grid) const {
    yaml.add("target_type", "'aprilgrid'");
    yaml.add("tagCols", std::to_string(grid.tag_cols));
    yaml.add("tagRows", std::to_string(grid.tag_rows));
    yaml.add("tagSize", yamlFloat(grid.tag_size_m));
    yaml.add("tagSpacing", yamlFloat(grid.tag_spacing_ratio));
    yaml.add("tagFamily", yamlString(grid.family));
    yaml.add("codeOffset", std::to_string(grid.code_offset));
    yaml.add("tagBorder", std::to_string(grid.border_cells));
  }
  void operator()(const target::Checkerboard& board) const {
    yaml.add("target_type", "'checkerboard'");
    yaml.add("targetCols", std::to_string(board.cols));
    yaml.add("targetRows", std::to_string(board.rows));
    yaml.add("rowSpacingMeters", yamlFloat(board.row_spacing_m));
    yaml.add("colSpacingMeters", yamlFloat(board.col_spacing_m));
  }
  void operator()(const target::CircleGrid& grid) const {
    yaml.add("target_type", "'circlegrid'");
    yaml.add("targetCols", std::to_string(grid.cols));
    yaml.add("targetRows", std::to_string(grid.rows));
    yaml.add("spacingMeters", yamlFloat(grid.spacing_m));
    yaml.add("asymmetricGrid", grid.asymmetric ? "true" : "false");
  }
};

}  // namespace

void addTargetKeys(YamlWriter& yaml, const target::Target& target) { std::visit(TargetWriter{yaml}, target); }

std::string targetText(const target::Target& target) {
  YamlWriter yaml;
  addTargetKeys(yaml, target);
  return yaml.text();
}

}  // namespace tartan_calib::io
