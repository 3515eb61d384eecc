#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "tartan_calib/solver/block_problem.h"

namespace tartan_calib::test_support {

/// Gradient of a problem's total cost and diagonal of its normal matrix, as its blocks state them: shared unknowns, then
/// block by block.
struct StatedDerivatives {
  double cost = 0.0;
  Eigen::VectorXd gradient;
  Eigen::VectorXd diagonal;
};

inline StatedDerivatives statedDerivatives(const solver::BlockProblem& problem) {
  const Eigen::Index size = problem.numShared() + solver::kBlockSize * problem.numBlocks();
  StatedDerivatives stated{0.0, Eigen::VectorXd::Zero(size), Eigen::VectorXd::Zero(size)};
  for (int k = 0; k < problem.numBlocks(); ++k) {
    const solver::BlockTerms terms = problem.linearize(k);
    const Eigen::Index at = problem.numShared() + solver::kBlockSize * k;
    stated.cost += terms.cost;
    for (std::size_t i = 0; i < terms.shared.size(); ++i) {
      const Eigen::Index local = static_cast<Eigen::Index>(i);
      stated.gradient(terms.shared[i]) += terms.g_s(local);
      stated.diagonal(terms.shared[i]) += terms.H_ss(local, local);
    }
    stated.gradient.segment<solver::kBlockSize>(at) = terms.g_b;
    stated.diagonal.segment<solver::kBlockSize>(at) = terms.H_bb.diagonal();
  }
  return stated;
}

inline double costAfter(solver::BlockProblem& problem, const Eigen::VectorXd& all_unknowns) {
  solver::Step step{all_unknowns.head(problem.numShared()), {}};
  for (int k = 0; k < problem.numBlocks(); ++k) {
    step.blocks.emplace_back(all_unknowns.segment<solver::kBlockSize>(problem.numShared() + solver::kBlockSize * k));
  }
  problem.save();
  problem.move(step);
  double cost = 0.0;
  for (int k = 0; k < problem.numBlocks(); ++k) {
    cost += problem.cost(k);
  }
  problem.restore();
  return cost;
}

/// Largest difference between the stated gradient and central differences of the cost, per unknown as a share of the largest
/// value that the gradient could have there: |J_i' r| <= |J_i| |r|.
inline double gradientError(solver::BlockProblem& problem, double step_size) {
  const StatedDerivatives stated = statedDerivatives(problem);
  double error = 0.0;
  for (Eigen::Index i = 0; i < stated.gradient.size(); ++i) {
    const Eigen::VectorXd step = step_size * Eigen::VectorXd::Unit(stated.gradient.size(), i);
    const double numeric = (costAfter(problem, step) - costAfter(problem, -step)) / (2.0 * step_size);
    const double largest = std::sqrt(stated.diagonal(i) * 2.0 * stated.cost);
    error = std::max(error, std::abs(stated.gradient(i) - numeric) / largest);
  }
  return error;
}

}  // namespace tartan_calib::test_support
