#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "batch_problem.h"

namespace tartan_calib::calibration {

/// The covariance of the solver's shared unknowns (T_cam_rig) in the layout of Solution::covariance (baselines).
Eigen::MatrixXd baselineCovariance(const Rig& rig, const SharedLayout& layout, const Eigen::MatrixXd& shared_covariance);

/// A name for a shared unknown: "cam1 extrinsics", "cam0 projection[2]", "cam0 distortion[0]", "board warp".
std::string unknownName(const Rig& rig, const SharedLayout& layout, int shared_index);

}  // namespace tartan_calib::calibration
