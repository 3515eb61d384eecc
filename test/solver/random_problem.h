#pragma once

#include <Eigen/Core>
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
    Eigen::MatrixXd B;
    Eigen::VectorXd c;
  };

  explicit RandomProblem(const RandomProblemOptions& options);

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

  double cost(int k) const override;
  BlockTerms linearize(int k) const override;

  void move(const Step& step) override;
  void save() override {
    saved_s_ = s_;
    saved_b_ = b_;
  }
  void restore() override {
    s_ = saved_s_;
    b_ = saved_b_;
  }

 private:
  Eigen::MatrixXd randomMatrix(int rows, int cols);
  const Block& at(int k) const { return blocks[static_cast<std::size_t>(k)]; }
  Eigen::VectorXd linear(int k) const;

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

DenseSystem denseSystem(const BlockProblem& problem);

/// H^-1, the covariance of all unknowns.
Eigen::MatrixXd inverseNormalMatrix(const BlockProblem& problem);

}  // namespace tartan_calib::solver
