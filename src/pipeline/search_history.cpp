#include "search_history.h"

#include <algorithm>

namespace tartan_calib::pipeline {
namespace {

/// Corners are looked for within some pixels of their predictions, and the refinement takes only the shape of the window
/// from them: what was found once is found again from here.
constexpr double kMoved_px = 0.5;
/// A corner that was missed may have been missed narrowly.
constexpr double kMovedWithMissing_px = 0.1;

std::optional<Eigen::Vector2d> prediction(const camera::Camera& camera, const detection::BoardMap& map,
                                          const Eigen::Vector3d& p_target) {
  const auto px = map(p_target.head<2>());
  return px && camera::isInside(camera, *px) ? px : std::nullopt;
}

}  // namespace

int countPredicted(const camera::Camera& camera, const detection::BoardMap& map,
                   const std::vector<Eigen::Vector3d>& target_points) {
  return static_cast<int>(std::count_if(target_points.begin(), target_points.end(), [&](const Eigen::Vector3d& p_target) {
    return prediction(camera, map, p_target).has_value();
  }));
}

bool hasMoved(const SearchedImage& before, const camera::Camera& camera, const detection::BoardMap& map,
              const std::vector<Eigen::Vector3d>& target_points) {
  const double limit_px = before.is_complete ? kMoved_px : kMovedWithMissing_px;
  return std::any_of(target_points.begin(), target_points.end(), [&](const Eigen::Vector3d& p_target) {
    const auto now_px = prediction(camera, map, p_target);
    const auto then_px = before.map(p_target.head<2>());
    return now_px && (!then_px || (*now_px - *then_px).norm() > limit_px);
  });
}

}  // namespace tartan_calib::pipeline
