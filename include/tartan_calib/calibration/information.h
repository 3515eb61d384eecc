#pragma once

#include <Eigen/Core>
#include <vector>

#include "tartan_calib/calibration/rig.h"
#include "tartan_calib/geometry/rigid3.h"
#include "tartan_calib/observation/observation.h"

namespace tartan_calib::calibration {

/// What one view of the board says about the unknowns of a rig: its part of the inverse of their covariance, the board's
/// pose eliminated. Unknowns: T_cam_rig of each camera >= 1 (6, perturbed from the left), then each camera's parameters. In
/// the units of the corners' covariances. Zero where the view does not determine the board's pose.
Eigen::MatrixXd viewInformation(const Rig& rig, const std::vector<Eigen::Vector3d>& target_points,
                                const observation::View& view, const geometry::Rigid3& T_rig_target);

}  // namespace tartan_calib::calibration
