#include "tag_payload.h"

#include "bilinear.h"
#include "correlation.h"

namespace tartan_calib::detection {
namespace {

/// A wrong payload of 36 cells correlates by 0 +- 0.17; no two codes of t36h11 by more than this.
constexpr double kConfirmingCorrelation = 0.5;
/// Of all codes in all turns one correlates by 0.5 to 0.75 with whatever is there, such as half a tag and a hand.
constexpr double kOtherTagCorrelation = 0.8;
/// With more blur the payloads of a family look alike; with less a slightly blurred one would not be recognised.
constexpr double kReadableBlurInCells = 0.55;

}  // namespace

TagPayload::TagPayload(const target::AprilGrid& grid)
    : grid_(grid),
      family_(target::tagFamily(grid.family)),
      family_patterns_(family_, 0, static_cast<int>(family_.codes.size()), {kReadableBlurInCells}),
      corner_points_(target::cornerPoints(grid)) {}

PayloadVerdict TagPayload::verdict(const cv::Mat& gray, const BoardMap& map, int tag_index,
                                   const Eigen::Vector2d& shift_px) const {
  const Cells cells = sample(gray, map, tag_index, shift_px);
  const int tag_id = grid_.code_offset + tag_index;
  if (correlation(cells, tag_id) > kConfirmingCorrelation) {
    return PayloadVerdict::kThisTag;
  }
  return showsOtherTag(cells, tag_id) ? PayloadVerdict::kOtherTag : PayloadVerdict::kUnclear;
}

TagPayload::Cells TagPayload::sample(const cv::Mat& gray, const BoardMap& map, int tag_index,
                                     const Eigen::Vector2d& shift_px) const {
  const double cell_m = grid_.tag_size_m / (family_.payload_cells + 2 * grid_.border_cells);
  const std::vector<int> corner_ids = target::tagCornerIds(grid_, tag_index);
  const Eigen::Vector2d top_left_m = corner_points_[static_cast<std::size_t>(corner_ids[3])].head<2>();
  Cells cells;
  for (int row = 0; row < family_.payload_cells; ++row) {
    for (int col = 0; col < family_.payload_cells; ++col) {
      const Eigen::Vector2d offset_m((grid_.border_cells + col + 0.5) * cell_m, -(grid_.border_cells + row + 0.5) * cell_m);
      const auto px = map(top_left_m + offset_m);
      const Eigen::Vector2d at = px ? Eigen::Vector2d(*px + shift_px) : Eigen::Vector2d::Constant(-1.0);
      cells.push_back(canSample(gray, at.x(), at.y()) ? std::make_optional(sampleBilinear(gray, at.x(), at.y()))
                                                      : std::nullopt);
    }
  }
  return cells;
}

/// Pearson's, of the cells that are seen.
double TagPayload::correlation(const Cells& cells, int tag_id) const {
  Correlation correlation;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (cells[i]) {
      const auto cell = static_cast<int>(i);
      const bool white = target::isWhiteCell(family_, tag_id, cell / family_.payload_cells, cell % family_.payload_cells);
      correlation.add(static_cast<double>(*cells[i]), white ? 1.0 : -1.0);
    }
  }
  return correlation.value();
}

bool TagPayload::showsOtherTag(const Cells& cells, int tag_id) const {
  std::vector<double> values;
  for (const std::optional<float>& cell : cells) {
    if (!cell) {
      return false;
    }
    values.push_back(static_cast<double>(*cell));
  }
  const PayloadPatterns::Likeness seen = family_patterns_.mostAlike(values);
  return seen.correlation > kOtherTagCorrelation && !(seen.tag_index == tag_id && seen.top_left == 0);
}

}  // namespace tartan_calib::detection
