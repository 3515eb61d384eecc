#include <algorithm>
#include <set>

#include "tartan_calib/pipeline/calibrate.h"

namespace tartan_calib::pipeline {

int minTags(const target::AprilGrid& grid) {
  return std::min(std::max(grid.tag_rows, grid.tag_cols) + 1, target::numTags(grid));
}

int countTags(const target::AprilGrid& grid, const std::vector<observation::Corner>& corners) {
  const int lattice_cols = 2 * grid.tag_cols;
  std::set<int> tags;
  for (const observation::Corner& corner : corners) {
    const int row = corner.corner_id / lattice_cols / 2;
    const int col = corner.corner_id % lattice_cols / 2;
    tags.insert(row * grid.tag_cols + col);
  }
  return static_cast<int>(tags.size());
}

}  // namespace tartan_calib::pipeline
