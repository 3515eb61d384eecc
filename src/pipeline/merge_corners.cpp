#include "merge_corners.h"

#include <algorithm>
#include <limits>
#include <map>

#include "tartan_calib/detection/refine.h"

namespace tartan_calib::pipeline {
namespace {

using observation::Corner;

/// Positions of one corner that are this close mean the same point of the image.
constexpr double kSamePlace_px = 0.5;

Eigen::Vector2d pointOf(const Corner& corner, const std::vector<Eigen::Vector3d>& target_points) {
  return target_points[static_cast<std::size_t>(corner.corner_id)].head<2>();
}

double distanceToPrediction(const Corner& corner, const detection::BoardMap& map,
                            const std::vector<Eigen::Vector3d>& target_points) {
  const auto px = map(pointOf(corner, target_points));
  return px ? (*px - corner.px).norm() : std::numeric_limits<double>::infinity();
}

}  // namespace

std::vector<Corner> refineInImage(const cv::Mat& gray, const detection::BoardMap& map,
                                  const std::vector<Eigen::Vector3d>& target_points, double half_window_m,
                                  const std::vector<Corner>& corners) {
  if (half_window_m <= 0.0) {
    return corners;
  }
  detection::RefineOptions options;
  options.half_window = half_window_m;
  std::vector<Corner> refined;
  for (const Corner& corner : corners) {
    const Eigen::Vector2d corner_m = pointOf(corner, target_points);
    const auto origin_px = map(corner_m);
    if (!origin_px) {
      continue;
    }
    const auto offset_map = [&](const Eigen::Vector2d& offset_m) -> Eigen::Vector2d {
      const auto px = map(corner_m + offset_m);
      return px ? Eigen::Vector2d(*px - *origin_px) : Eigen::Vector2d::Constant(std::numeric_limits<double>::quiet_NaN());
    };
    if (const auto found = detection::refineBySymmetry(gray, corner.px, offset_map, options)) {
      refined.push_back({corner.corner_id, found->px, found->cov_px2});
    }
  }
  return refined;
}

void mergeCorners(const std::vector<Corner>& more, const detection::BoardMap& map,
                  const std::vector<Eigen::Vector3d>& target_points, std::vector<Corner>& corners) {
  std::map<int, Corner> by_id;
  for (const Corner& corner : corners) {
    by_id[corner.corner_id] = corner;
  }
  for (const Corner& corner : more) {
    Corner& known = by_id.emplace(corner.corner_id, corner).first->second;
    const double known_px = distanceToPrediction(known, map, target_points);
    if (distanceToPrediction(corner, map, target_points) + kSamePlace_px < known_px) {
      known = corner;
    }
  }
  corners.clear();
  for (const auto& entry : by_id) {
    corners.push_back(entry.second);
  }
}

}  // namespace tartan_calib::pipeline
