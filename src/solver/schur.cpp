#include "schur.h"

#include <Eigen/Cholesky>
#include <array>
#include <utility>

#include "tartan_calib/solver/parallel.h"

namespace tartan_calib::solver {
namespace {

Eigen::Index numTouched(const BlockTerms& block) { return static_cast<Eigen::Index>(block.shared.size()); }

void subtractEliminated(const BlockTerms& block, const BlockMatrix& inverse, ReducedSystem& sum) {
  const BlockRows inverse_times_bs = inverse * block.H_bs;
  const Eigen::MatrixXd eliminated = block.H_bs.transpose() * inverse_times_bs;
  const Eigen::VectorXd eliminated_g = inverse_times_bs.transpose() * block.g_b;
  for (Eigen::Index col = 0; col < numTouched(block); ++col) {
    const int shared_col = block.shared[static_cast<std::size_t>(col)];
    sum.g(shared_col) -= eliminated_g(col);
    for (Eigen::Index row = 0; row < numTouched(block); ++row) {
      sum.S(block.shared[static_cast<std::size_t>(row)], shared_col) -= eliminated(row, col);
    }
  }
}

/// (H_bb + damping diag(H_bb))^-1, empty where that is not positive definite.
std::optional<BlockMatrix> dampedInverse(const BlockMatrix& H_bb, double damping) {
  // Unit diagonal first: metres and radians differ by orders of magnitude.
  const BlockVector scale = dampingScale(H_bb).cwiseSqrt().cwiseInverse();
  BlockMatrix scaled = scale.asDiagonal() * H_bb * scale.asDiagonal();
  scaled.diagonal().array() += damping;
  const Eigen::LLT<BlockMatrix> factor(scaled);
  if (factor.info() != Eigen::Success) {
    return std::nullopt;
  }
  return BlockMatrix(scale.asDiagonal() * factor.solve(BlockMatrix::Identity()) * scale.asDiagonal());
}

std::optional<std::vector<BlockMatrix>> dampedInverses(const NormalEquations& equations, double damping) {
  std::vector<BlockMatrix> inverses;
  inverses.reserve(equations.blocks.size());
  for (const BlockTerms& block : equations.blocks) {
    const std::optional<BlockMatrix> inverse = dampedInverse(block.H_bb, damping);
    if (!inverse) {
      return std::nullopt;
    }
    inverses.push_back(*inverse);
  }
  return inverses;
}

/// S_ff d_f = -(g_f + S_fp d_p) for the free unknowns f, given the prescribed ones p.
std::optional<Eigen::VectorXd> solveReduced(const ReducedSystem& reduced, const Prescribed& prescribed) {
  const std::vector<int> free = prescribed.freeIndices();
  const Eigen::Index size = static_cast<Eigen::Index>(free.size());
  const Eigen::VectorXd g = reduced.g + reduced.S * prescribed.step;
  Eigen::MatrixXd S(size, size);
  Eigen::VectorXd scale(size);
  Eigen::VectorXd rhs(size);
  for (Eigen::Index i = 0; i < size; ++i) {
    const int row = free[static_cast<std::size_t>(i)];
    if (!(reduced.S(row, row) > 0.0)) {
      return std::nullopt;
    }
    scale(i) = 1.0 / std::sqrt(reduced.S(row, row));
    rhs(i) = -scale(i) * g(row);
    for (Eigen::Index j = 0; j <= i; ++j) {
      S(i, j) = scale(i) * scale(j) * reduced.S(row, free[static_cast<std::size_t>(j)]);
    }
  }
  const Eigen::LLT<Eigen::MatrixXd> factor(S);
  if (factor.info() != Eigen::Success) {
    return std::nullopt;
  }
  const Eigen::VectorXd solution = factor.solve(rhs);
  Eigen::VectorXd step = prescribed.step;
  for (Eigen::Index i = 0; i < size; ++i) {
    step(free[static_cast<std::size_t>(i)]) = scale(i) * solution(i);
  }
  return step;
}

}  // namespace

ReducedSystem reduce(const NormalEquations& equations, const std::vector<BlockMatrix>& inverses, int num_threads) {
  const Eigen::Index num_shared = equations.g_s.size();
  std::array<ReducedSystem, kNumChunks> sums;
  forEachChunk(static_cast<int>(equations.blocks.size()), num_threads, [&](const Chunk& chunk) {
    ReducedSystem sum{Eigen::MatrixXd::Zero(num_shared, num_shared), Eigen::VectorXd::Zero(num_shared)};
    for (int block = chunk.begin; block < chunk.end; ++block) {
      const std::size_t k = static_cast<std::size_t>(block);
      subtractEliminated(equations.blocks[k], inverses[k], sum);
    }
    sums[static_cast<std::size_t>(chunk.index)] = std::move(sum);
  });
  ReducedSystem reduced{equations.H_ss, equations.g_s};
  for (const ReducedSystem& sum : sums) {
    reduced.S += sum.S;
    reduced.g += sum.g;
  }
  return reduced;
}

std::optional<Step> solveSchur(const NormalEquations& equations, double damping, const Prescribed& prescribed,
                               int num_threads) {
  const std::optional<std::vector<BlockMatrix>> inverses = dampedInverses(equations, damping);
  if (!inverses) {
    return std::nullopt;
  }
  ReducedSystem reduced = reduce(equations, *inverses, num_threads);
  reduced.S.diagonal() += damping * dampingScale(equations.H_ss);
  std::optional<Eigen::VectorXd> shared_step = solveReduced(reduced, prescribed);
  if (!shared_step) {
    return std::nullopt;
  }
  Step step{std::move(*shared_step), {}};
  step.blocks.reserve(equations.blocks.size());
  for (std::size_t k = 0; k < equations.blocks.size(); ++k) {
    const BlockTerms& block = equations.blocks[k];
    step.blocks.emplace_back(-(*inverses)[k] * (block.g_b + timesShared(block, step.shared)));
  }
  return step;
}

}  // namespace tartan_calib::solver
