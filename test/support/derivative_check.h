#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "tartan_calib/solver/block_problem.h"

namespace tartan_calib::test_support {

/// The gradient of a problem's total cost as its blocks state it: shared unknowns, then block by block.
inline Eigen::VectorXd statedGradient(const solver::BlockProblem& problem) {
  Eigen::VectorXd gradient = Eigen::VectorXd::Zero(problem.numShared() + solver::kBlockSize * problem.numBlocks());
  for (int k = 0; k < problem.numBlocks(); ++k) {
    const solver::BlockTerms terms = problem.linearize(k);
    for (std::size_t i = 0; i < terms.shared.size(); ++i) {
      gradient(terms.shared[i]) += terms.g_s(static_cast<Eigen::Index>(i));
    }
    gradient.segment<solver::kBlockSize>(problem.numShared() + solver::kBlockSize * k) = terms.g_b;
  }
  return gradient;
}

inline double costAfter(solver::BlockProblem& problem, const Eigen::VectorXd& all_unknowns) {
  solver::Step step{all_unknowns.head(problem.numShared()), {}};
  for (int k = 0; k < problem.numBlocks(); ++k) {
    step.blocks.emplace_back(all_unknowns.segment<solver::kBlockSize>(problem.numShared() + solver::kBlockSize * k));
  }
  problem.move(step);
  double cost = 0.0;
  for (int k = 0; k < problem.numBlocks(); ++k) {
    cost += problem.cost(k);
  }
  problem.undo();
  return cost;
}

/// Largest difference between the stated gradient and central differences of the cost, relative to the gradient's size or
/// the cost's curvature over the step, whichever is larger per unknown.
inline double gradientError(solver::BlockProblem& problem, double step_size) {
  const Eigen::VectorXd stated = statedGradient(problem);
  double error = 0.0;
  for (Eigen::Index i = 0; i < stated.size(); ++i) {
    const auto cost = [&](double size) { return costAfter(problem, size * Eigen::VectorXd::Unit(stated.size(), i)); };
    const double ahead = cost(step_size);
    const double behind = cost(-step_size);
    const double numeric = (ahead - behind) / (2.0 * step_size);
    const double scale = std::max({std::abs(stated(i)), std::abs(numeric), 1e-6});
    error = std::max(error, std::abs(stated(i) - numeric) / scale);
  }
  return error;
}

}  // namespace tartan_calib::test_support
