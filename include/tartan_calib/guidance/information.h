#pragma once

#include <Eigen/Core>

#include "tartan_calib/calibration/rig.h"

namespace tartan_calib::guidance {

/// What is known about a rig before anything is seen, in the layout of calibration::viewInformation and for corners with a
/// stdev of 1 px: so little that a few views outweigh it, so that a determinant always exists.
Eigen::MatrixXd priorInformation(const calibration::Rig& rig);

/// By how many bits more is known with `added` than without: 1/2 log2 det(known + added) / det(known). `known` is positive
/// definite.
double gainBits(const Eigen::MatrixXd& known, const Eigen::MatrixXd& added);

}  // namespace tartan_calib::guidance
