#pragma once

#include <vector>

#include "batch_problem.h"
#include "tartan_calib/calibration/solve.h"

namespace tartan_calib::calibration {

/// Robust stdev of the whitened residual components of each camera's used corners (1.4826 median |e|), never below what the
/// usual misfit of a lens makes of them.
std::vector<double> robustSigmas(const BatchProblem& batch);

/// Decides anew, from the current state, which corners take part. True where that changed for any corner.
/// A corner is rejected if the model gives it no image; if it is a gross error; by the sigma rule, with all rules; or if its
/// view is left with too few corners for a pose.
enum class Selection { kGrossErrors, kAllRules };
bool selectCorners(const SolveOptions& options, Selection selection, BatchProblem& batch);

}  // namespace tartan_calib::calibration
