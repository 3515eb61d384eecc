#pragma once

#include "tartan_calib/calibration/solve.h"

namespace tartan_calib::pipeline {

/// Throws CalibrationError where the solver did not converge and left a focal length about as uncertain as itself: such
/// parameters mean nothing.
void checkSolution(const calibration::Solution& solution);

}  // namespace tartan_calib::pipeline
