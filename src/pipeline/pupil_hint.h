#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "tartan_calib/calibration/solve.h"

namespace tartan_calib::pipeline {

/// Where a solution leaves residuals larger than corners are wrong: solves once more with moving entrance pupils
/// (camera::PupilShift), and says so if that explains most of them.
std::optional<std::string> pupilHint(const calibration::Solution& solution, const calibration::SolveOptions& options,
                                     const std::vector<Eigen::Vector3d>& target_points);

}  // namespace tartan_calib::pipeline
