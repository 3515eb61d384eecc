#pragma once

#include <vector>

#include "batch_problem.h"

namespace tartan_calib::calibration {

/// By camera, the stdev [px] that has to be added in quadrature to the used corners' own so that their residuals have unit
/// variance: what the lens model cannot follow. 0 where the corners' own is enough.
std::vector<double> modelErrors(const BatchProblem& batch);

/// Weighs every corner by its own covariance plus its camera's model error: sharp corners would otherwise bend a model that
/// is too simple towards themselves.
void setModelErrors(const std::vector<double>& sigmas_px, BatchProblem& batch);

}  // namespace tartan_calib::calibration
