#include "tartan_calib/solver/covariance.h"

#include <Eigen/Eigenvalues>
#include <cmath>

#include "normal_equations.h"
#include "schur.h"

namespace tartan_calib::solver {
namespace {

/// Of a normal matrix with unit diagonal: below it, a direction's stdev is a million times what it would be if all other
/// unknowns were known, which no rounding and no noise of real data leaves meaningful.
constexpr double kRankTolerance = 1e-12;

/// Share of the largest component from which on an unknown counts as part of an undetermined direction.
constexpr double kNamedComponent = 0.1;

struct PseudoInverse {
  Eigen::MatrixXd inverse;
  Eigen::MatrixXd null_space;  ///< in units of scale, columns
  int rank = 0;
};

/// Pseudo-inverse of H whose smallness is judged against `scale`, a positive diagonal.
PseudoInverse pseudoInverse(const Eigen::MatrixXd& H, const Eigen::VectorXd& scale) {
  if (H.rows() == 0) {  // everything is held: Eigen's solver does not take empty matrices
    return {Eigen::MatrixXd(0, 0), Eigen::MatrixXd(0, 0), 0};
  }
  const Eigen::VectorXd unit = scale.cwiseSqrt().cwiseInverse();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(unit.asDiagonal() * H * unit.asDiagonal());
  const Eigen::Index size = H.rows();
  Eigen::Index nullity = 0;
  while (nullity < size && !(eigen.eigenvalues()(nullity) > kRankTolerance)) {
    ++nullity;
  }
  const auto range = eigen.eigenvectors().rightCols(size - nullity);
  const Eigen::MatrixXd half =
      unit.asDiagonal() * range * eigen.eigenvalues().tail(size - nullity).cwiseSqrt().cwiseInverse().asDiagonal();
  return {half * half.transpose(), eigen.eigenvectors().leftCols(nullity), static_cast<int>(size - nullity)};
}

std::vector<int> involvedUnknowns(const Eigen::MatrixXd& null_space) {
  std::vector<int> involved;
  for (Eigen::Index i = 0; i < null_space.rows(); ++i) {
    bool is_involved = false;
    for (Eigen::Index direction = 0; direction < null_space.cols(); ++direction) {
      const double largest = null_space.col(direction).cwiseAbs().maxCoeff();
      is_involved = is_involved || std::abs(null_space(i, direction)) > kNamedComponent * largest;
    }
    if (is_involved) {
      involved.push_back(static_cast<int>(i));
    }
  }
  return involved;
}

template <typename Matrix>
Matrix selected(const Matrix& H, const std::vector<int>& indices) {
  const Eigen::Index size = static_cast<Eigen::Index>(indices.size());
  Matrix part(size, size);
  for (Eigen::Index col = 0; col < size; ++col) {
    for (Eigen::Index row = 0; row < size; ++row) {
      part(row, col) = H(indices[static_cast<std::size_t>(row)], indices[static_cast<std::size_t>(col)]);
    }
  }
  return part;
}

}  // namespace

SharedCovariance sharedCovariance(const BlockProblem& problem, int num_threads) {
  const NormalEquations equations = linearizeAll(problem, num_threads);
  const Prescribed held = holdActiveBounds(equations, problem.stepLimits());
  const std::vector<int> free = held.freeIndices();

  SharedCovariance result;
  std::vector<BlockMatrix> inverses;
  inverses.reserve(equations.blocks.size());
  for (const BlockTerms& block : equations.blocks) {
    const PseudoInverse inverse = pseudoInverse(block.H_bb, dampingScale(block.H_bb));
    inverses.emplace_back(inverse.inverse);
    result.block_rank += inverse.rank;
  }
  const Eigen::MatrixXd S = reduce(equations, inverses, num_threads).S;
  const Eigen::MatrixXd H_free = selected(equations.H_ss, free);
  const PseudoInverse inverse = pseudoInverse(selected(S, free), dampingScale(H_free));

  result.rank = inverse.rank;
  result.covariance = Eigen::MatrixXd::Zero(S.rows(), S.cols());
  for (std::size_t col = 0; col < free.size(); ++col) {
    for (std::size_t row = 0; row < free.size(); ++row) {
      result.covariance(free[row], free[col]) =
          inverse.inverse(static_cast<Eigen::Index>(row), static_cast<Eigen::Index>(col));
    }
  }
  for (const int i : involvedUnknowns(inverse.null_space)) {
    result.undetermined.push_back(free[static_cast<std::size_t>(i)]);
  }
  for (std::size_t i = 0; i < held.is_prescribed.size(); ++i) {
    if (held.is_prescribed[i]) {
      result.at_bound.push_back(static_cast<int>(i));
    }
  }
  return result;
}

}  // namespace tartan_calib::solver
