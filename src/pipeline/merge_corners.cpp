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

/// Corners farther from their predictions than this, and than several times what is usual in the image, are something else:
/// the edge of a hand that covers the corner.
constexpr double kFits_px = 1.0;
constexpr double kUsualFactor = 3.0;

/// How far from its prediction a corner of this image may be: as good as the model and the pose are where most were seen.
double fitLimit(const std::vector<double>& distances_px) {
  std::vector<double> sorted = distances_px;
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
  std::nth_element(sorted.begin(), middle, sorted.end());
  return std::max(kFits_px, kUsualFactor * *middle);
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
  std::vector<double> distances_px;
  for (const Corner& corner : more) {
    distances_px.push_back(distanceToPrediction(corner, map, target_points));
  }
  const double limit_px = more.empty() ? 0.0 : fitLimit(distances_px);
  for (std::size_t i = 0; i < more.size(); ++i) {
    if (distances_px[i] > limit_px) {
      continue;
    }
    Corner& known = by_id.emplace(more[i].corner_id, more[i]).first->second;
    if (distances_px[i] + kSamePlace_px < distanceToPrediction(known, map, target_points)) {
      known = more[i];
    }
  }
  corners.clear();
  for (const auto& entry : by_id) {
    corners.push_back(entry.second);
  }
}

}  // namespace tartan_calib::pipeline
