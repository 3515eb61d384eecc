#pragma once

#include <Eigen/Core>

#include "tartan_calib/calibration/solve.h"

namespace tartan_calib::calibration {

/// Of the parameters of one camera's model.
Eigen::MatrixXd intrinsicsCovariance(const Solution& solution, int camera_index);

/// Relative stdev of the image scale [px/rad] on the optical axis: of the focal length, whatever the model calls it. (fu of
/// ds-none may be open where the scale is known: xi and alpha make up for it.)
double focalStdevRatio(const Solution& solution, int camera_index);

/// From here on a focal length is no knowledge. Usable calibrations stay below 0.01; those of too few views below 0.1.
constexpr double kMeaninglessFocal_ratio = 0.2;

}  // namespace tartan_calib::calibration
