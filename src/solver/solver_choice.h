#pragma once

#include "normal_equations.h"

namespace tartan_calib::solver {

/// Whether solveSparse is expected to be faster than solveSchur on equations of this size and structure.
bool isSparseFaster(const NormalEquations& equations);

}  // namespace tartan_calib::solver
