#pragma once

#include <functional>

#include "tartan_calib/solver/block_problem.h"

namespace tartan_calib::solver {

enum class LinearSolver {
  kAuto,    ///< the faster one for the problem's size
  kSchur,   ///< blocks eliminated, dense reduced system of the shared unknowns
  kSparse,  ///< CHOLMOD on the whole normal equations
};

struct Options {
  LinearSolver linear_solver = LinearSolver::kAuto;
  int num_threads = 0;  ///< 0: all cores. The result has the same bits for every value
  int max_iterations = 100;
  /// Converged once a Gauss-Newton step promises to lower the cost by less than the larger of these.
  double relative_tolerance = 1e-12;  ///< times the cost
  double absolute_tolerance = 0.0;
  double initial_damping = 1e-6;  ///< of diag(H): close to Gauss-Newton, for starts that are usually good
  double newton_damping = 1e-9;   ///< of diag(H): up to here a step counts as a Gauss-Newton step
  /// Part of the cost that a step may promise and not keep at the minimum, and that several iterations must gain to be worth
  /// others. In a valley that is bent as well as nearly flat the quadratic model promises without end what no step gains.
  double negligible_ratio = 1e-8;
  std::function<bool(int iteration, double cost)> progress;  ///< after every iteration; false ends the solve
};

enum class Status {
  kConverged,
  kMaxIterations,
  kStalled,  ///< no step lowers the cost although the gradient promises one that is not negligible
  kCancelled,
};

struct Summary {
  Status status = Status::kStalled;
  int iterations = 0;
  double initial_cost = 0.0;
  double final_cost = 0.0;
};

/// Moves the problem's state to a local minimum of its cost within the bounds. The cost never rises. Unknowns that the cost
/// does not determine stay where they are, up to damping.
Summary minimize(BlockProblem& problem, const Options& options);

}  // namespace tartan_calib::solver
