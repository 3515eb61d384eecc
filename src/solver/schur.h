#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "normal_equations.h"

namespace tartan_calib::solver {

/// The shared unknowns' equations S d_s = -g after elimination of the blocks.
struct ReducedSystem {
  Eigen::MatrixXd S;
  Eigen::VectorXd g;
};

/// S = H_ss - sum_k H_sb inverse_k H_bs, with the given (pseudo-)inverse of each block's H_bb.
ReducedSystem reduce(const NormalEquations& equations, const std::vector<BlockMatrix>& inverses, int num_threads);

/// Minimises 1/2 d'(H + damping diag(H)) d + g'd over the free unknowns, blocks eliminated, the reduced system by a dense
/// Cholesky factorisation. Empty where H is numerically indefinite.
std::optional<Step> solveSchur(const NormalEquations& equations, double damping, const Prescribed& prescribed,
                               int num_threads);

}  // namespace tartan_calib::solver
