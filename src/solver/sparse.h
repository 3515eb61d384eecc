#pragma once

#include <optional>

#include "normal_equations.h"

namespace tartan_calib::solver {

/// As solveSchur, by a sparse Cholesky factorisation (CHOLMOD) of the whole normal equations.
std::optional<Step> solveSparse(const NormalEquations& equations, double damping, const Prescribed& prescribed);

}  // namespace tartan_calib::solver
