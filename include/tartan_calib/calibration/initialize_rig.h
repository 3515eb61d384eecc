#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "tartan_calib/calibration/rig.h"
#include "tartan_calib/calibration/solve.h"
#include "tartan_calib/camera/camera.h"
#include "tartan_calib/observation/observation.h"

namespace tartan_calib::calibration {

/// Start for the joint solve from cameras started one by one: extrinsics along the best-connected tree, a pose per view.
/// Views that nothing explains are left out of the problem. Throws CalibrationError with the groups and the shared views
/// per pair where cameras are not connected. `known_rig`: the cameras' extrinsics are kept from it (--init).
Problem initializeRig(const std::vector<camera::Camera>& cameras, const std::vector<Eigen::Vector3d>& target_points,
                      const std::vector<observation::View>& views, const std::optional<Rig>& known_rig = std::nullopt);

}  // namespace tartan_calib::calibration
