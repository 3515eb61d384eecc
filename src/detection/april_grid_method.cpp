#include <algorithm>

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

/// Half of the widest window around a corner [tag sides] that holds no payload and no neighbouring corner.
double refineHalfWindow(const target::AprilGrid& grid, const target::TagFamily& family) {
  const double border = static_cast<double>(grid.border_cells) / (family.payload_cells + 2 * grid.border_cells);
  return std::min(0.8 * border, 0.5 * grid.tag_spacing_ratio);
}

/// Drops every tag that was found more than once.
void dropDuplicates(std::vector<PlacedTag>& tags, DetectionCounts& counts) {
  std::vector<PlacedTag> single;
  for (const PlacedTag& tag : tags) {
    const auto copies =
        std::count_if(tags.begin(), tags.end(), [&](const PlacedTag& t) { return t.tag_index == tag.tag_index; });
    if (copies == 1) {
      single.push_back(tag);
    } else {
      ++counts.duplicate_tags;
    }
  }
  tags = std::move(single);
}

class AprilGridMethod : public DetectionMethod {
 public:
  AprilGridMethod(const target::AprilGrid& grid, const DetectorOptions& options)
      : grid_(grid), options_(options), reader_(target::tagFamily(grid.family)) {
    refine_.half_window = refineHalfWindow(grid, reader_.family());
  }

  Detection detect(const cv::Mat& gray) const override {
    const std::vector<Saddle> saddles = findSaddles(gray);
    const BoardSearch search{gray, saddles, grid_, reader_, options_.max_hamming};
    Detection detection;
    std::vector<PlacedTag> tags;
    for (const SaddleLattice& lattice : growLattices(gray, saddles)) {
      const auto found = findLatticeTags(search, lattice, detection.counts);
      tags.insert(tags.end(), found.begin(), found.end());
    }
    dropDuplicates(tags, detection.counts);
    completeBoard(search, tags);
    for (const PlacedTag& tag : tags) {
      if (isClearOfBorder(search, tag)) {
        addCorners(search, tag, detection);
      }
    }
    std::sort(detection.corners.begin(), detection.corners.end(),
              [](const auto& a, const auto& b) { return a.corner_id < b.corner_id; });
    return detection;
  }

 private:
  bool isClearOfBorder(const BoardSearch& search, const PlacedTag& tag) const {
    const double margin_px = options_.min_border_distance_px;
    return std::all_of(tag.saddle_index.begin(), tag.saddle_index.end(), [&](int i) {
      const Eigen::Vector2d& px = search.saddles[static_cast<std::size_t>(i)].px;
      return px.x() >= margin_px && px.y() >= margin_px && px.x() <= search.gray.cols - 1 - margin_px &&
             px.y() <= search.gray.rows - 1 - margin_px;
    });
  }

  void addCorners(const BoardSearch& search, const PlacedTag& tag, Detection& detection) const {
    const std::vector<int> corner_ids = target::tagCornerIds(grid_, tag.tag_index);
    for (std::size_t k = 0; k < 4; ++k) {
      const Saddle& saddle = search.saddles[static_cast<std::size_t>(tag.saddle_index[k])];
      const Eigen::Vector2d uv(k == 1 || k == 2 ? 1.0 : 0.0, k >= 2 ? 1.0 : 0.0);
      const Eigen::Vector2d corner_px = tag.map(uv);
      RefineOptions refine = refine_;
      refine.max_shift_px = options_.max_refine_shift_px * saddle.scale_px;
      const auto refined = refineBySymmetry(
          search.gray, saddle.px, [&](const Eigen::Vector2d& s) { return Eigen::Vector2d(tag.map(uv + s) - corner_px); },
          refine);
      if (refined) {
        detection.corners.push_back({corner_ids[3 - k], refined->px, refined->cov_px2, true});
      }
    }
    ++detection.counts.tags;
  }

  target::AprilGrid grid_;
  DetectorOptions options_;
  TagReader reader_;
  RefineOptions refine_;
};

}  // namespace

std::unique_ptr<const DetectionMethod> makeAprilGridMethod(const target::AprilGrid& grid, const DetectorOptions& options) {
  return std::make_unique<AprilGridMethod>(grid, options);
}

}  // namespace tartan_calib::detection
