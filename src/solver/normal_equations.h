#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "tartan_calib/solver/block_problem.h"

namespace tartan_calib::solver {

/// The normal equations of the whole problem around its current state.
struct NormalEquations {
  double cost = 0.0;
  Eigen::MatrixXd H_ss;
  Eigen::VectorXd g_s;
  std::vector<BlockTerms> blocks;  ///< H_ss and g_s are empty: they are summed above
};

NormalEquations linearizeAll(const BlockProblem& problem, int num_threads);
double totalCost(const BlockProblem& problem, int num_threads);

/// Shared unknowns whose step is given instead of sought.
struct Prescribed {
  std::vector<bool> is_prescribed;
  Eigen::VectorXd step;

  std::vector<int> freeIndices() const;
};

/// Holds the unknowns that sit at a bound and whose gradient points out of it.
Prescribed holdActiveBounds(const NormalEquations& equations, const StepLimits& limits);

/// Marquardt's scaling of the damping: the diagonal of H, or 1 where it vanishes.
template <typename Matrix>
Eigen::Matrix<double, Matrix::RowsAtCompileTime, 1> dampingScale(const Matrix& H) {
  return H.diagonal().unaryExpr([](double h) { return h > 0.0 ? h : 1.0; });
}

/// The cost along a step d as the equations see it, without damping: cost + slope t + 1/2 curvature t^2 at t d.
struct Prediction {
  double slope = 0.0;      ///< g'd
  double curvature = 0.0;  ///< d'H d

  double change() const { return slope + 0.5 * curvature; }  ///< of the cost, by the whole step
};

Prediction predict(const NormalEquations& equations, const Step& step);

/// H_bs d_s, for the shared unknowns that the block touches.
BlockVector timesShared(const BlockTerms& block, const Eigen::VectorXd& shared_step);

}  // namespace tartan_calib::solver
