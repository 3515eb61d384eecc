#include "../../src/solver/solver_choice.h"

#include <gtest/gtest.h>

#include "random_problem.h"

namespace tartan_calib::solver {
namespace {

NormalEquations equationsOf(int num_shared, int num_blocks, int num_touched) {
  RandomProblemOptions sizes;
  sizes.num_shared = num_shared;
  sizes.num_blocks = num_blocks;
  sizes.num_touched = num_touched;
  sizes.num_residuals = 8;
  return linearizeAll(RandomProblem(sizes), 1);
}

TEST(SolverChoice, EliminatesBlocksWhereTheyShareFewUnknowns) {
  EXPECT_FALSE(isSparseFaster(equationsOf(6, 100, 6)));    // one camera
  EXPECT_FALSE(isSparseFaster(equationsOf(60, 100, 60)));  // four cameras
  EXPECT_FALSE(isSparseFaster(equationsOf(120, 100, 120)));
}

TEST(SolverChoice, StaysSparseWhereEachBlockTouchesFewOfMany) {
  EXPECT_TRUE(isSparseFaster(equationsOf(600, 100, 20)));
  EXPECT_FALSE(isSparseFaster(equationsOf(300, 40, 300)));
}

}  // namespace
}  // namespace tartan_calib::solver
