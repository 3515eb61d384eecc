#pragma once

#include <Eigen/Core>
#include <string>

#include "tartan_calib/pipeline/calibrate.h"

namespace tartan_calib::io {

/// Kalibr's results-cam.txt: cameras, baselines and target, and a last line that says how `+-` is scaled.
std::string resultsText(const pipeline::CalibrationResult& result);

/// numpy's text of a vector under suppress=True, precision=8, as Kalibr prints parameters.
std::string arrayText(const Eigen::VectorXd& values);

/// The same for a matrix, row by row.
std::string matrixText(const Eigen::MatrixXd& values);

}  // namespace tartan_calib::io
