#include "solver_choice.h"

#include "tartan_calib/solver/parallel.h"

namespace tartan_calib::solver {
namespace {

// Cost per unit of work in nanoseconds, fitted to both solvers on one core for 10-1500 shared unknowns and 100-2000 blocks
// (within 30 %). Only their ratios matter.
constexpr double kDenseElimination_ns = 0.15;  ///< per multiply-add of small dense products
constexpr double kDenseFactor_ns = 0.35;       ///< per multiply-add, and per element summed over chunks
constexpr double kSparse_ns = 1.0;             ///< per multiply-add behind an index
constexpr double kSparseBlock_ns = 6000.0;     ///< assembly and ordering of a block

/// Multiply-adds that eliminate the blocks.
double eliminationWork(const NormalEquations& equations) {
  double work = 0.0;
  for (const BlockTerms& block : equations.blocks) {
    const double num_touched = static_cast<double>(block.shared.size());
    work += 2.0 * kBlockSize * num_touched * num_touched;
  }
  return work;
}

}  // namespace

bool isSparseFaster(const NormalEquations& equations) {
  const double n = static_cast<double>(equations.g_s.size());
  const double filled = static_cast<double>((equations.H_ss.array() != 0.0).count());
  const double num_blocks = static_cast<double>(equations.blocks.size());
  const double elimination = eliminationWork(equations);
  const double schur_ns =
      kDenseElimination_ns * elimination + kDenseFactor_ns * (n * n * n / 3.0 + (kNumChunks + 1) * n * n);
  // A sparse factor of n columns with as many elements as H_ss has: n^3 / 3 where that is dense.
  const double sparse_ns = kSparse_ns * (elimination + filled * filled / (3.0 * (n + 1.0))) + kSparseBlock_ns * num_blocks;
  return sparse_ns < schur_ns;
}

}  // namespace tartan_calib::solver
