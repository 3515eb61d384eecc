#include "normal_equations.h"

#include <array>
#include <utility>

#include "tartan_calib/solver/parallel.h"

namespace tartan_calib::solver {
namespace {

struct SharedSum {
  double cost = 0.0;
  Eigen::MatrixXd H;
  Eigen::VectorXd g;
};

void addShared(const BlockTerms& terms, SharedSum& sum) {
  const Eigen::Index size = static_cast<Eigen::Index>(terms.shared.size());
  sum.cost += terms.cost;
  for (Eigen::Index col = 0; col < size; ++col) {
    const int shared_col = terms.shared[static_cast<std::size_t>(col)];
    sum.g(shared_col) += terms.g_s(col);
    for (Eigen::Index row = 0; row < size; ++row) {
      sum.H(terms.shared[static_cast<std::size_t>(row)], shared_col) += terms.H_ss(row, col);
    }
  }
}

}  // namespace

NormalEquations linearizeAll(const BlockProblem& problem, int num_threads) {
  const int num_shared = problem.numShared();
  NormalEquations equations;
  equations.H_ss = Eigen::MatrixXd::Zero(num_shared, num_shared);
  equations.g_s = Eigen::VectorXd::Zero(num_shared);
  equations.blocks.resize(static_cast<std::size_t>(problem.numBlocks()));

  std::array<SharedSum, kNumChunks> sums;
  forEachChunk(problem.numBlocks(), num_threads, [&](const Chunk& chunk) {
    SharedSum sum{0.0, Eigen::MatrixXd::Zero(num_shared, num_shared), Eigen::VectorXd::Zero(num_shared)};
    for (int block = chunk.begin; block < chunk.end; ++block) {
      BlockTerms& terms = equations.blocks[static_cast<std::size_t>(block)];
      terms = problem.linearize(block);
      addShared(terms, sum);
      terms.H_ss.resize(0, 0);
      terms.g_s.resize(0);
    }
    sums[static_cast<std::size_t>(chunk.index)] = std::move(sum);
  });
  for (const SharedSum& sum : sums) {
    equations.cost += sum.cost;
    equations.H_ss += sum.H;
    equations.g_s += sum.g;
  }
  return equations;
}

double totalCost(const BlockProblem& problem, int num_threads) {
  std::array<double, kNumChunks> costs{};
  forEachChunk(problem.numBlocks(), num_threads, [&](const Chunk& chunk) {
    double cost = 0.0;
    for (int block = chunk.begin; block < chunk.end; ++block) {
      cost += problem.cost(block);
    }
    costs[static_cast<std::size_t>(chunk.index)] = cost;
  });
  double total = 0.0;
  for (const double cost : costs) {
    total += cost;
  }
  return total;
}

std::vector<int> Prescribed::freeIndices() const {
  std::vector<int> indices;
  for (std::size_t i = 0; i < is_prescribed.size(); ++i) {
    if (!is_prescribed[i]) {
      indices.push_back(static_cast<int>(i));
    }
  }
  return indices;
}

Prescribed holdActiveBounds(const NormalEquations& equations, const StepLimits& limits) {
  const Eigen::VectorXd& g = equations.g_s;
  Prescribed held{std::vector<bool>(static_cast<std::size_t>(g.size()), false), Eigen::VectorXd::Zero(g.size())};
  for (Eigen::Index i = 0; i < g.size(); ++i) {
    held.is_prescribed[static_cast<std::size_t>(i)] =
        (limits.lower(i) >= 0.0 && g(i) > 0.0) || (limits.upper(i) <= 0.0 && g(i) < 0.0);
  }
  return held;
}

BlockVector timesShared(const BlockTerms& block, const Eigen::VectorXd& shared_step) {
  BlockVector product = BlockVector::Zero();
  for (std::size_t i = 0; i < block.shared.size(); ++i) {
    product += shared_step(block.shared[i]) * block.H_bs.col(static_cast<Eigen::Index>(i));
  }
  return product;
}

Prediction predict(const NormalEquations& equations, const Step& step) {
  Prediction prediction{step.shared.dot(equations.g_s), step.shared.dot(equations.H_ss * step.shared)};
  for (std::size_t k = 0; k < equations.blocks.size(); ++k) {
    const BlockTerms& block = equations.blocks[k];
    const BlockVector& d = step.blocks[k];
    prediction.slope += d.dot(block.g_b);
    prediction.curvature += d.dot(2.0 * timesShared(block, step.shared) + block.H_bb * d);
  }
  return prediction;
}

}  // namespace tartan_calib::solver
