#include "tartan_calib/geometry/linear_solve.h"

#include <gtest/gtest.h>

namespace tartan_calib::geometry {
namespace {

/// Its eigenvalues are 1 + off and 1 - off.
Eigen::MatrixXd twoByTwo(double off) { return (Eigen::Matrix2d() << 1.0, off, off, 1.0).finished(); }

TEST(LinearSolve, SolvesADefiniteSystem) {
  const Eigen::MatrixXd H = twoByTwo(0.5);
  const Eigen::MatrixXd x = (Eigen::Matrix2d() << 3.0, -1.0, 2.0, 0.5).finished();
  const auto found = solveDefinite(H, H * x, 1e-3);
  ASSERT_TRUE(found);
  EXPECT_LT((*found - x).norm(), 1e-14);
  EXPECT_LT((solveSymmetric(H, Eigen::VectorXd(H * x.col(0))) - x.col(0)).norm(), 1e-14);
}

TEST(LinearSolve, HasNoSolutionWhereUnknownsCannotBeToldApart) {
  EXPECT_FALSE(solveDefinite(twoByTwo(0.9999), twoByTwo(0.0), 1e-3));
  EXPECT_FALSE(solveDefinite(twoByTwo(1.0), twoByTwo(0.0), 1e-13));
  EXPECT_FALSE(solveDefinite(twoByTwo(2.0), twoByTwo(0.0), 1e-13));
}

}  // namespace
}  // namespace tartan_calib::geometry
