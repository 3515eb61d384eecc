#pragma once

#include <Eigen/Core>
#include <limits>
#include <random>
#include <vector>

#include "tartan_calib/solver/block_problem.h"

namespace tartan_calib::solver {

struct RandomProblemOptions {
  int num_shared = 11;
  int num_blocks = 40;
  int num_touched = 4;  ///< shared unknowns per block
  int num_residuals = 16;
  double bend = 0.1;  ///< of the residuals r = y + bend sin(y) - c, y linear in the unknowns; 0: linear least squares
  unsigned seed = 1;
};

/// Residuals r = y + bend sin(y) - c with y = A s + B b, random A, B and c.
class RandomProblem : public BlockProblem {
 public:
  struct Block {
    std::vector<int> touched;
    Eigen::MatrixXd A;
    Eigen::Matrix<double, Eigen::Dynamic, kBlockSize> B;
    Eigen::VectorXd c;
  };

  explicit RandomProblem(const RandomProblemOptions& options) : bend_(options.bend), random_(options.seed) {
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

  std::vector<Block> blocks;

  void setBounds(int shared, double lower, double upper) {
    limits_.lower(shared) = lower;
    limits_.upper(shared) = upper;
  }
  const Eigen::VectorXd& shared() const { return s_; }
  const std::vector<BlockVector>& own() const { return b_; }

  int numShared() const override { return static_cast<int>(s_.size()); }
  int numBlocks() const override { return static_cast<int>(blocks.size()); }
  StepLimits stepLimits() const override { return {limits_.lower - s_, limits_.upper - s_}; }

  double cost(int k) const override {
    const Eigen::ArrayXd y = linear(k);
    return 0.5 * (y + bend_ * y.sin() - at(k).c.array()).square().sum();
  }

  BlockTerms linearize(int k) const override {
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

  void move(const Step& step) override {
    s_ = (s_ + step.shared).cwiseMax(limits_.lower).cwiseMin(limits_.upper);
    for (std::size_t k = 0; k < b_.size(); ++k) {
      b_[k] += step.blocks[k];
    }
  }
  void save() override {
    saved_s_ = s_;
    saved_b_ = b_;
  }
  void restore() override {
    s_ = saved_s_;
    b_ = saved_b_;
  }

 private:
  Eigen::MatrixXd randomMatrix(int rows, int cols) {
    std::normal_distribution<double> normal;
    return Eigen::MatrixXd::NullaryExpr(rows, cols, [&] { return normal(random_); });
  }
  const Block& at(int k) const { return blocks[static_cast<std::size_t>(k)]; }
  Eigen::ArrayXd linear(int k) const {
    Eigen::VectorXd touched(static_cast<Eigen::Index>(at(k).touched.size()));
    for (Eigen::Index i = 0; i < touched.size(); ++i) {
      touched(i) = s_(at(k).touched[static_cast<std::size_t>(i)]);
    }
    return at(k).A * touched + at(k).B * b_[static_cast<std::size_t>(k)];
  }

  double bend_;
  std::mt19937 random_;
  StepLimits limits_;
  Eigen::VectorXd s_;
  Eigen::VectorXd saved_s_;
  std::vector<BlockVector> b_;
  std::vector<BlockVector> saved_b_;
};

/// The normal equations of all unknowns (shared, then block by block) as one dense matrix.
struct DenseSystem {
  Eigen::MatrixXd H;
  Eigen::VectorXd g;
};

inline DenseSystem denseSystem(const BlockProblem& problem) {
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

}  // namespace tartan_calib::solver
