#include "random_problem.h"

#include <Eigen/LU>
#include <limits>

namespace tartan_calib::solver {

RandomProblem::RandomProblem(const RandomProblemOptions& options) : bend_(options.bend), random_(options.seed) {
  s_ = Eigen::VectorXd::Zero(options.num_shared);
  limits_ = {Eigen::VectorXd::Constant(options.num_shared, -std::numeric_limits<double>::infinity()),
             Eigen::VectorXd::Constant(options.num_shared, std::numeric_limits<double>::infinity())};
  for (int k = 0; k < options.num_blocks; ++k) {
    Block block;
    for (int i = 0; i < options.num_touched; ++i) {
      block.touched.push_back((k + i * (options.num_shared / options.num_touched)) % options.num_shared);
    }
    block.A = randomMatrix(options.num_residuals, options.num_touched);
    block.B = randomMatrix(options.num_residuals, kBlockSize);
    block.c = randomMatrix(options.num_residuals, 1);
    blocks.push_back(block);
    b_.emplace_back(BlockVector::Zero());
  }
}

double RandomProblem::cost(int k) const {
  const Eigen::ArrayXd y = linear(k);
  return 0.5 * (y + bend_ * y.sin() - at(k).c.array()).square().sum();
}

BlockTerms RandomProblem::linearize(int k) const {
  const Block& block = at(k);
  const Eigen::ArrayXd y = linear(k);
  const Eigen::VectorXd r = y + bend_ * y.sin() - block.c.array();
  const Eigen::VectorXd slope = 1.0 + bend_ * y.cos();
  const Eigen::MatrixXd J_s = slope.asDiagonal() * block.A;
  const Eigen::MatrixXd J_b = slope.asDiagonal() * block.B;
  BlockTerms terms;
  terms.cost = 0.5 * r.squaredNorm();
  terms.shared = block.touched;
  terms.H_ss = J_s.transpose() * J_s;
  terms.g_s = J_s.transpose() * r;
  terms.H_bs = J_b.transpose() * J_s;
  terms.H_bb = J_b.transpose() * J_b;
  terms.g_b = J_b.transpose() * r;
  return terms;
}

void RandomProblem::move(const Step& step) {
  s_ = (s_ + step.shared).cwiseMax(limits_.lower).cwiseMin(limits_.upper);
  for (std::size_t k = 0; k < b_.size(); ++k) {
    b_[k] += step.blocks[k];
  }
}

Eigen::MatrixXd RandomProblem::randomMatrix(int rows, int cols) {
  std::normal_distribution<double> normal;
  return Eigen::MatrixXd::NullaryExpr(rows, cols, [&] { return normal(random_); });
}

Eigen::VectorXd RandomProblem::linear(int k) const {
  Eigen::VectorXd touched(static_cast<Eigen::Index>(at(k).touched.size()));
  for (Eigen::Index i = 0; i < touched.size(); ++i) {
    touched(i) = s_(at(k).touched[static_cast<std::size_t>(i)]);
  }
  return at(k).A * touched + at(k).B * b_[static_cast<std::size_t>(k)];
}

DenseSystem denseSystem(const BlockProblem& problem) {
  const Eigen::Index size = problem.numShared() + kBlockSize * problem.numBlocks();
  DenseSystem dense{Eigen::MatrixXd::Zero(size, size), Eigen::VectorXd::Zero(size)};
  for (int k = 0; k < problem.numBlocks(); ++k) {
    const BlockTerms terms = problem.linearize(k);
    const Eigen::Index at = problem.numShared() + kBlockSize * k;
    dense.H.block<kBlockSize, kBlockSize>(at, at) = terms.H_bb;
    dense.g.segment<kBlockSize>(at) = terms.g_b;
    for (std::size_t i = 0; i < terms.shared.size(); ++i) {
      const Eigen::Index local = static_cast<Eigen::Index>(i);
      dense.g(terms.shared[i]) += terms.g_s(local);
      dense.H.block<kBlockSize, 1>(at, terms.shared[i]) = terms.H_bs.col(local);
      dense.H.block<1, kBlockSize>(terms.shared[i], at) = terms.H_bs.col(local).transpose();
      for (std::size_t j = 0; j < terms.shared.size(); ++j) {
        dense.H(terms.shared[i], terms.shared[j]) += terms.H_ss(local, static_cast<Eigen::Index>(j));
      }
    }
  }
  return dense;
}

Eigen::MatrixXd inverseNormalMatrix(const BlockProblem& problem) { return denseSystem(problem).H.inverse(); }

}  // namespace tartan_calib::solver
