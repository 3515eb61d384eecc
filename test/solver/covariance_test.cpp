#include "tartan_calib/solver/covariance.h"

#include <gtest/gtest.h>

#include "random_problem.h"
#include "tartan_calib/solver/levenberg_marquardt.h"

namespace tartan_calib::solver {
namespace {

constexpr int kAllCores = 0;

TEST(SharedCovariance, IsTheSharedPartOfTheInverseNormalMatrix) {
  RandomProblem problem({});
  minimize(problem, {});
  const SharedCovariance result = sharedCovariance(problem, kAllCores);
  const Eigen::MatrixXd expected = inverseNormalMatrix(problem).topLeftCorner(problem.numShared(), problem.numShared());
  EXPECT_LT((result.covariance - expected).norm(), 1e-9 * expected.norm());
  EXPECT_EQ(result.rank, problem.numShared());
  EXPECT_EQ(result.block_rank, kBlockSize * problem.numBlocks());
  EXPECT_TRUE(result.undetermined.empty());
  EXPECT_TRUE(result.at_bound.empty());
}

TEST(SharedCovariance, NamesUnknownsThatOnlyTheirSumIsKnownOf) {
  RandomProblemOptions sizes;
  sizes.num_touched = sizes.num_shared;
  RandomProblem problem(sizes);
  for (RandomProblem::Block& block : problem.blocks) {
    for (std::size_t i = 0; i < block.touched.size(); ++i) {
      if (block.touched[i] == 2 || block.touched[i] == 7) {
        block.A.col(static_cast<Eigen::Index>(i)).setOnes();
      }
    }
  }
  minimize(problem, {});
  const SharedCovariance result = sharedCovariance(problem, kAllCores);
  EXPECT_EQ(result.undetermined, (std::vector<int>{2, 7}));
  EXPECT_EQ(result.rank, problem.numShared() - 1);
  EXPECT_TRUE(result.covariance.allFinite());
  EXPECT_GT(result.covariance(0, 0), 0.0);
}

TEST(SharedCovariance, NamesUnknownsThatNothingTouches) {
  RandomProblem problem({});
  for (RandomProblem::Block& block : problem.blocks) {
    for (std::size_t i = 0; i < block.touched.size(); ++i) {
      if (block.touched[i] == 4) {
        block.A.col(static_cast<Eigen::Index>(i)).setZero();
      }
    }
  }
  const SharedCovariance result = sharedCovariance(problem, kAllCores);
  EXPECT_EQ(result.undetermined, std::vector<int>{4});
  EXPECT_LT(result.covariance.row(4).norm(), 1e-12 * result.covariance.norm());
}

TEST(SharedCovariance, IgnoresWhatABlockWithTooFewResidualsLeavesOpen) {
  RandomProblem problem({});
  RandomProblem without({});
  // Two residuals cannot even determine the block's own six unknowns: nothing is left for the shared ones.
  RandomProblem::Block& block = problem.blocks[0];
  block.A.bottomRows(block.A.rows() - 2).setZero();
  block.B.bottomRows(block.B.rows() - 2).setZero();
  without.blocks[0].A.setZero();
  without.blocks[0].B.setZero();
  const SharedCovariance result = sharedCovariance(problem, kAllCores);
  const SharedCovariance expected = sharedCovariance(without, kAllCores);
  EXPECT_LT((result.covariance - expected.covariance).norm(), 1e-9 * expected.covariance.norm());
  EXPECT_EQ(result.block_rank, kBlockSize * (problem.numBlocks() - 1) + 2);
}

TEST(SharedCovariance, HoldsUnknownsAtTheirBound) {
  RandomProblem free({});
  minimize(free, {});
  RandomProblem problem({});
  const double bound = 0.5 * free.shared()(1);
  problem.setBounds(1, bound > 0.0 ? -1.0 : bound, bound > 0.0 ? bound : 1.0);
  minimize(problem, {});
  const SharedCovariance result = sharedCovariance(problem, kAllCores);
  EXPECT_EQ(result.at_bound, std::vector<int>{1});
  EXPECT_EQ(result.covariance.row(1).norm(), 0.0);
  EXPECT_LT(result.covariance(0, 0), sharedCovariance(free, kAllCores).covariance(0, 0));
}

}  // namespace
}  // namespace tartan_calib::solver
