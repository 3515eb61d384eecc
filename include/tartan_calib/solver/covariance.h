#pragma once

#include <Eigen/Core>
#include <vector>

#include "tartan_calib/solver/block_problem.h"

namespace tartan_calib::solver {

/// What the normal equations at a minimum say about the shared unknowns.
struct SharedCovariance {
  /// Inverse of the normal matrix with the blocks eliminated: the covariance for residuals of unit variance. Zero rows for
  /// unknowns at a bound; directions that the cost does not determine are left out (pseudo-inverse).
  Eigen::MatrixXd covariance;
  int rank = 0;                   ///< number of determined directions
  int block_rank = 0;             ///< summed over the blocks
  std::vector<int> at_bound;      ///< unknowns held by a bound
  std::vector<int> undetermined;  ///< unknowns that take part in a direction that the cost does not determine
};

/// `num_threads` 0: all cores.
SharedCovariance sharedCovariance(const BlockProblem& problem, int num_threads);

}  // namespace tartan_calib::solver
