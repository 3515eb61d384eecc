#include "quad_match.h"

#include <algorithm>
#include <limits>

namespace tartan_calib::detection {
namespace {

/// A predicted tag: corner ids and pixels in the order of target::tagCornerIds.
struct PredictedTag {
  std::vector<int> corner_ids;
  Quad corners_px;
};

std::vector<PredictedTag> predictedTags(const target::AprilGrid& grid,
                                        const std::vector<std::optional<Eigen::Vector2d>>& predicted_px) {
  std::vector<PredictedTag> tags;
  for (int tag_index = 0; tag_index < target::numTags(grid); ++tag_index) {
    PredictedTag tag{target::tagCornerIds(grid, tag_index), {}};
    const auto at = [&](std::size_t i) { return predicted_px[static_cast<std::size_t>(tag.corner_ids[i])]; };
    if (at(0) && at(1) && at(2) && at(3)) {
      tag.corners_px = {*at(0), *at(1), *at(2), *at(3)};
      tags.push_back(tag);
    }
  }
  return tags;
}

bool isMirrored(const Quad& quad) {
  const Eigen::Vector2d a = quad[2] - quad[0];
  const Eigen::Vector2d b = quad[3] - quad[1];
  return a.x() * b.y() - a.y() * b.x() < 0.0;
}

/// Largest distance between corners in the order that fits best, and the quadrilateral in that order.
std::pair<double, Quad> inOrderOf(const Quad& tag, Quad quad) {
  if (isMirrored(quad) != isMirrored(tag)) {
    std::reverse(quad.begin(), quad.end());
  }
  std::pair<double, Quad> best{std::numeric_limits<double>::infinity(), quad};
  for (int turn = 0; turn < 4; ++turn) {
    std::rotate(quad.begin(), quad.begin() + 1, quad.end());
    double distance_px = 0.0;
    for (std::size_t i = 0; i < 4; ++i) {
      distance_px = std::max(distance_px, (quad[i] - tag[i]).norm());
    }
    if (distance_px < best.first) {
      best = {distance_px, quad};
    }
  }
  return best;
}

}  // namespace

QuadCorners matchQuads(const std::vector<Quad>& quads, const target::AprilGrid& grid,
                       const std::vector<std::optional<Eigen::Vector2d>>& predicted_px, double max_distance_px) {
  QuadCorners corners;
  for (const PredictedTag& tag : predictedTags(grid, predicted_px)) {
    std::pair<double, Quad> closest{std::numeric_limits<double>::infinity(), {}};
    for (const Quad& quad : quads) {
      const auto ordered = inOrderOf(tag.corners_px, quad);
      closest = ordered.first < closest.first ? ordered : closest;
    }
    if (closest.first <= max_distance_px) {
      for (std::size_t i = 0; i < 4; ++i) {
        corners[tag.corner_ids[i]] = closest.second[i];
      }
    }
  }
  return corners;
}

}  // namespace tartan_calib::detection
