#include <algorithm>
#include <set>
#include <string>

#include "board_completion.h"
#include "detection_method.h"
#include "lattice_tags.h"
#include "placed_tag.h"
#include "tartan_calib/detection/lattice.h"
#include "tartan_calib/detection/refine.h"
#include "tartan_calib/detection/saddle.h"
#include "tartan_calib/error.h"

namespace tartan_calib::detection {
namespace {

const target::TagFamily& familyOf(const target::AprilGrid& grid) {
  const target::TagFamily& family = target::tagFamily(grid.family);
  const auto num_codes = static_cast<int>(family.codes.size());
  if (grid.code_offset < 0 || grid.code_offset + target::numTags(grid) > num_codes) {
    throw InputError("the aprilgrid needs tags " + std::to_string(grid.code_offset) + " to " +
                     std::to_string(grid.code_offset + target::numTags(grid) - 1) + ", but " + grid.family + " has only " +
                     std::to_string(num_codes) + "; check tagRows, tagCols, codeOffset and tagFamily");
  }
  return family;
}

/// Half of the widest window around a corner [tag sides] that holds no payload and no neighbouring corner.
double refineHalfWindow(const target::AprilGrid& grid, const target::TagFamily& family) {
  const double border = static_cast<double>(grid.border_cells) / (family.payload_cells + 2 * grid.border_cells);
  return std::min(0.8 * border, 0.5 * grid.tag_spacing_ratio);
}

/// Drops every tag that was found more than once and returns the indices of those.
std::set<int> dropDuplicates(std::vector<PlacedTag>& tags, DetectionCounts& counts) {
  std::set<int> seen;
  std::set<int> duplicates;
  for (const PlacedTag& tag : tags) {
    if (!seen.insert(tag.tag_index).second) {
      duplicates.insert(tag.tag_index);
    }
  }
  const auto first_dropped = std::stable_partition(
      tags.begin(), tags.end(), [&](const PlacedTag& tag) { return duplicates.count(tag.tag_index) == 0; });
  counts.duplicate_tags += static_cast<int>(tags.end() - first_dropped);
  tags.erase(first_dropped, tags.end());
  return duplicates;
}

/// Scale at which most corners of the board are seen best: the blur of the image. A corner that is coarser on its own is
/// covered in part.
double medianScale(const std::vector<Saddle>& saddles, const std::vector<PlacedTag>& tags) {
  std::vector<double> scales_px = {1.0};
  for (const PlacedTag& tag : tags) {
    for (const int i : tag.saddle_index) {
      scales_px.push_back(i < 0 ? 1.0 : saddles[static_cast<std::size_t>(i)].scale_px);
    }
  }
  const auto middle = scales_px.begin() + static_cast<std::ptrdiff_t>(scales_px.size() / 2);
  std::nth_element(scales_px.begin(), middle, scales_px.end());
  return *middle;
}

struct TagCorner {
  int id;
  RefinedCorner refined;
};

/// Drops corners that are much less symmetric than most of the board: something covers them in part.
void dropDisturbed(std::vector<TagCorner>& corners) {
  constexpr double kAlwaysFine = 0.1;  // asymmetry in units of the contrast
  constexpr double kFactor = 2.2;      // recorded: 99 % of clear corners are below 1.7 times the median, covered ones above
  if (corners.empty()) {
    return;
  }
  std::vector<double> ratios;
  for (const TagCorner& corner : corners) {
    ratios.push_back(corner.refined.residual_ratio);
  }
  const auto middle = ratios.begin() + static_cast<std::ptrdiff_t>(ratios.size() / 2);
  std::nth_element(ratios.begin(), middle, ratios.end());
  const double limit = std::max(kAlwaysFine, kFactor * *middle);
  corners.erase(std::remove_if(corners.begin(), corners.end(),
                               [limit](const TagCorner& c) { return c.refined.residual_ratio > limit; }),
                corners.end());
}

class AprilGridMethod : public DetectionMethod {
 public:
  AprilGridMethod(const target::AprilGrid& grid, const DetectorOptions& options)
      : grid_(grid),
        options_(options),
        reader_(familyOf(grid)),
        patterns_(reader_.family(), grid.code_offset, target::numTags(grid)) {
    refine_.half_window = refineHalfWindow(grid, reader_.family());
  }

  Detection detect(const cv::Mat& gray) const override {
    const std::vector<Saddle> saddles = findSaddles(gray);
    const BoardSearch search{gray, saddles, grid_, reader_, patterns_, options_.max_hamming};
    Detection detection;
    std::vector<PlacedTag> tags;
    for (const SaddleLattice& lattice : growLattices(gray, saddles)) {
      const auto found = findLatticeTags(search, lattice, detection.counts);
      tags.insert(tags.end(), found.begin(), found.end());
    }
    completeBoard(search, dropDuplicates(tags, detection.counts), tags);
    std::vector<TagCorner> corners;
    const double scale_px = medianScale(saddles, tags);
    for (const PlacedTag& tag : tags) {
      const auto refined = refineTag(search, tag, scale_px);
      corners.insert(corners.end(), refined.begin(), refined.end());
      detection.counts.tags += refined.empty() ? 0 : 1;
    }
    dropDisturbed(corners);
    for (const TagCorner& corner : corners) {
      detection.corners.push_back({corner.id, corner.refined.px, corner.refined.cov_px2, true});
    }
    std::sort(detection.corners.begin(), detection.corners.end(),
              [](const auto& a, const auto& b) { return a.corner_id < b.corner_id; });
    return detection;
  }

 private:
  /// The corners of a tag that could be refined; none where the tag is too close to the image's border.
  std::vector<TagCorner> refineTag(const BoardSearch& search, const PlacedTag& tag, double scale_px) const {
    const std::vector<int> corner_ids = target::tagCornerIds(grid_, tag.tag_index);
    std::vector<TagCorner> corners;
    for (std::size_t k = 0; k < 4; ++k) {
      const auto refined = refineCorner(search, tag, k, scale_px);
      if (!isClearOfBorder(search.gray, refined ? refined->px : tag.corners_px[k])) {
        return {};
      }
      if (refined) {
        corners.push_back({corner_ids[3 - k], *refined});  // ids are counted the other way round, from the bottom left
      }
    }
    return corners;
  }

  std::optional<RefinedCorner> refineCorner(const BoardSearch& search, const PlacedTag& tag, std::size_t k,
                                            double scale_px) const {
    if (tag.saddle_index[k] < 0) {
      return std::nullopt;
    }
    const Eigen::Vector2d uv(k == 1 || k == 2 ? 1.0 : 0.0, k >= 2 ? 1.0 : 0.0);
    const auto map = [&](const Eigen::Vector2d& offset) {
      return Eigen::Vector2d(tag.map(uv + offset) - tag.corners_px[k]);
    };
    RefineOptions refine = refine_;
    refine.scale_px = scale_px;
    refine.max_shift_px =
        options_.max_refine_shift_px * search.saddles[static_cast<std::size_t>(tag.saddle_index[k])].scale_px;
    return refineBySymmetry(search.gray, tag.corners_px[k], map, refine);
  }

  bool isClearOfBorder(const cv::Mat& gray, const Eigen::Vector2d& px) const {
    const double to_edge_px = 0.5 + std::min({px.x(), px.y(), gray.cols - 1 - px.x(),
                                              gray.rows - 1 - px.y()});  // the edge of a pixel, not its centre
    return to_edge_px >= options_.min_border_distance_px;
  }

  target::AprilGrid grid_;
  DetectorOptions options_;
  TagReader reader_;
  PayloadPatterns patterns_;
  RefineOptions refine_;
};

}  // namespace

std::unique_ptr<const DetectionMethod> makeAprilGridMethod(const target::AprilGrid& grid, const DetectorOptions& options) {
  return std::make_unique<AprilGridMethod>(grid, options);
}

}  // namespace tartan_calib::detection
