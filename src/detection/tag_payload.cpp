#include "tag_payload.h"

#include "bilinear.h"
#include "correlation.h"

namespace tartan_calib::detection {
TagPayload::TagPayload(const target::AprilGrid& grid)
    : grid_(grid), family_(target::tagFamily(grid.family)), corner_points_(target::cornerPoints(grid)) {}

double TagPayload::correlation(const cv::Mat& gray, const BoardMap& map, int tag_index,
                               const Eigen::Vector2d& shift_px) const {
  const int cells = family_.payload_cells + 2 * grid_.border_cells;
  const double cell_m = grid_.tag_size_m / cells;
  const std::vector<int> corner_ids = target::tagCornerIds(grid_, tag_index);
  const Eigen::Vector2d top_left_m = corner_points_[static_cast<std::size_t>(corner_ids[3])].head<2>();
  Correlation correlation;
  for (int row = 0; row < family_.payload_cells; ++row) {
    for (int col = 0; col < family_.payload_cells; ++col) {
      const Eigen::Vector2d offset_m((grid_.border_cells + col + 0.5) * cell_m, -(grid_.border_cells + row + 0.5) * cell_m);
      const auto px = map(top_left_m + offset_m);
      const Eigen::Vector2d at = px ? Eigen::Vector2d(*px + shift_px) : Eigen::Vector2d::Constant(-1.0);
      if (canSample(gray, at.x(), at.y())) {
        const bool white = target::isWhiteCell(family_, grid_.code_offset + tag_index, row, col);
        correlation.add(sampleBilinear(gray, at.x(), at.y()), white ? 1.0 : -1.0);
      }
    }
  }
  return correlation.value();
}

}  // namespace tartan_calib::detection
