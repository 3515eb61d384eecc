#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "tartan_calib/calibration/rig.h"
#include "tartan_calib/calibration/solve.h"
#include "tartan_calib/camera/camera.h"
#include "tartan_calib/observation/observation.h"

namespace tartan_calib::calibration {

struct RigStartOptions {
  std::optional<Rig> known_rig;  ///< from --init: the cameras' extrinsics are kept from it
  /// T_rig_target of views in the known rig, by view; those without are estimated. Empty: of none.
  std::vector<std::optional<geometry::Rigid3>> known_poses;
  int num_threads = 0;  ///< 0: all cores. The result has the same bits for every value
};

/// Start for the joint solve from cameras started one by one: extrinsics along the best-connected tree, a pose per view.
/// Views that nothing explains are left out of the problem. Throws CalibrationError with the groups and the shared views
/// per pair where cameras are not connected.
Problem initializeRig(const std::vector<camera::Camera>& cameras, const std::vector<Eigen::Vector3d>& target_points,
                      const std::vector<observation::View>& views, const RigStartOptions& options = {});

}  // namespace tartan_calib::calibration
