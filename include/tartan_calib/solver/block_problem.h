#pragma once

#include <Eigen/Core>
#include <vector>

namespace tartan_calib::solver {

constexpr int kBlockSize = 6;
using BlockVector = Eigen::Matrix<double, kBlockSize, 1>;
using BlockMatrix = Eigen::Matrix<double, kBlockSize, kBlockSize>;
using BlockRows = Eigen::Matrix<double, kBlockSize, Eigen::Dynamic>;

/// One block's part of the normal equations H d = -g around the current state, with H = J'J and g = J'r of its (weighted)
/// residuals r. `s` are the shared unknowns that the block touches, `b` its own six.
struct BlockTerms {
  double cost = 0.0;        ///< 1/2 |r|^2, or what a robust loss makes of it
  std::vector<int> shared;  ///< indices of the shared unknowns behind the rows of H_ss and g_s, without repetition
  Eigen::MatrixXd H_ss;     ///< both triangles
  Eigen::VectorXd g_s;
  BlockRows H_bs;
  BlockMatrix H_bb = BlockMatrix::Zero();
  BlockVector g_b = BlockVector::Zero();
};

/// A change of all unknowns, in their tangent spaces.
struct Step {
  Eigen::VectorXd shared;
  std::vector<BlockVector> blocks;
};

/// How far each shared unknown may still go: lower <= 0 <= upper, +-infinity where it is free, 0 at a bound.
struct StepLimits {
  Eigen::VectorXd lower;
  Eigen::VectorXd upper;
};

/// Least squares over shared unknowns and many blocks of six, where blocks meet only through the shared unknowns:
///   cost(s, b_0, b_1, ...) = sum over k of cost_k(s, b_k).
/// The problem owns the state. `cost` and `linearize` are called from several threads at once, for different blocks.
class BlockProblem {
 public:
  virtual ~BlockProblem() = default;

  virtual int numShared() const = 0;
  virtual int numBlocks() const = 0;
  virtual StepLimits stepLimits() const = 0;

  virtual double cost(int block) const = 0;
  virtual BlockTerms linearize(int block) const = 0;

  /// Goes to `state (+) step`. Steps within the limits leave the state within its bounds, and on them where they reach them.
  virtual void move(const Step& step) = 0;

  /// Remembers the state, and returns to the one remembered last.
  virtual void save() = 0;
  virtual void restore() = 0;
};

}  // namespace tartan_calib::solver
