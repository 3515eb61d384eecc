#pragma once

#include <string>
#include <vector>

#include "tartan_calib/calibration/camera_graph.h"
#include "tartan_calib/guidance/board_candidates.h"
#include "tartan_calib/guidance/board_shape.h"
#include "tartan_calib/guidance/coverage_map.h"

namespace tartan_calib::guidance {

/// What was collected of one camera so far.
struct CameraCollection {
  CoverageMap coverage;
  std::vector<BoardShape> shapes;  ///< one per image
};

/// What to do next while no calibration exists: what the images lack most, tilts, regions without corners, or close-ups.
std::string coverageAdvice(const std::vector<CameraCollection>& cameras, const calibration::CameraGraph& graph);

/// How to bring a board from where it is to where it should be.
std::string moveAdvice(const BoardPlacement& from, const BoardPlacement& to, const camera::Camera& camera);

/// Where to hold a board that is not in sight.
std::string placeAdvice(const BoardPlacement& to, const camera::Camera& camera);

}  // namespace tartan_calib::guidance
