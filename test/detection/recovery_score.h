#pragma once

#include <algorithm>
#include <map>
#include <opencv2/core.hpp>
#include <optional>
#include <vector>

#include "support/board_scene.h"
#include "tartan_calib/detection/board_map.h"
#include "tartan_calib/observation/observation.h"

namespace tartan_calib::detection {

/// The exact one of a flat board.
inline BoardMap flatBoardMap(const camera::Camera& camera, const geometry::Rigid3& T_cam_target) {
  return [camera, T_cam_target](const Eigen::Vector2d& p_m) {
    return camera::project(camera.model, T_cam_target * Eigen::Vector3d(p_m.x(), p_m.y(), 0.0));
  };
}

/// How recovered corners compare with the truth.
struct RecoveryScore {
  int expected = 0;  ///< inside the image by the border and at least 4 px from the next corner
  int found = 0;     ///< of those, within 0.5 px
  int wrong = 0;     ///< reported and further away
  double median_px = 0.0;
};

inline RecoveryScore recoveryScore(const std::vector<observation::Corner>& corners,
                                   const std::vector<simulation::TrueCorner>& truth) {
  std::map<int, Eigen::Vector2d> true_px;
  RecoveryScore result;
  for (const simulation::TrueCorner& corner : truth) {
    true_px[corner.corner_id] = corner.px;
    result.expected += corner.visible && corner.neighbour_distance_px >= 4.0 ? 1 : 0;
  }
  std::vector<double> errors_px;
  for (const observation::Corner& corner : corners) {
    const auto match = true_px.find(corner.corner_id);
    const double error_px = match == true_px.end() ? 1e9 : (match->second - corner.px).norm();
    ++(error_px < 0.5 ? result.found : result.wrong);
    errors_px.push_back(error_px);
  }
  if (!errors_px.empty()) {
    const auto middle = errors_px.begin() + static_cast<std::ptrdiff_t>(errors_px.size() / 2);
    std::nth_element(errors_px.begin(), middle, errors_px.end());
    result.median_px = *middle;
  }
  return result;
}

}  // namespace tartan_calib::detection
