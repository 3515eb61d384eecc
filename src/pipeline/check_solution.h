#pragma once

#include "tartan_calib/calibration/solve.h"

namespace tartan_calib::pipeline {

/// Throws CalibrationError where the parameters mean nothing: the solver did not converge and left a focal length about as
/// uncertain as itself, a camera has no corner that the solve used, or, where `is_rig_open`, such corners do not connect the
/// cameras.
void checkSolution(const calibration::Solution& solution, bool is_rig_open);

}  // namespace tartan_calib::pipeline
