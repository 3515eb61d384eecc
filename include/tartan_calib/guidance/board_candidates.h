#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "tartan_calib/calibration/rig.h"
#include "tartan_calib/geometry/rigid3.h"
#include "tartan_calib/guidance/board_shape.h"
#include "tartan_calib/guidance/coverage_map.h"

namespace tartan_calib::guidance {

/// A place where the board could be held, and what a view of it there would say.
struct BoardCandidate {
  int camera_index = 0;  ///< in whose image it is described
  geometry::Rigid3 T_rig_target;
  observation::View view;       ///< what would be seen of it
  Eigen::MatrixXd information;  ///< calibration::viewInformation, for corners with a stdev of 1 px
};

/// For every camera: places all over the lit part of its image, times distances, times tilts. Those of which too little
/// would be seen are left out.
std::vector<BoardCandidate> boardCandidates(const calibration::Rig& rig, const std::vector<Eigen::Vector3d>& target_points,
                                            const std::vector<CoverageMap>& coverage);

/// Where a board is, as one would tell somebody who holds it.
struct BoardPlacement {
  Eigen::Vector2d centre_px = Eigen::Vector2d::Zero();
  double distance_m = 0.0;
  Tilt tilt = Tilt::kNone;
};

/// Empty where the camera does not see the middle of the board.
std::optional<BoardPlacement> boardPlacement(const calibration::RigCamera& rig_camera,
                                             const std::vector<Eigen::Vector3d>& target_points,
                                             const geometry::Rigid3& T_rig_target);

/// The edge of the board in the image of a camera, as far as it is in front of the lens: pieces of a closed line.
std::vector<std::vector<Eigen::Vector2d>> boardOutline(const calibration::RigCamera& rig_camera,
                                                       const std::vector<Eigen::Vector3d>& target_points,
                                                       const geometry::Rigid3& T_rig_target);

}  // namespace tartan_calib::guidance
