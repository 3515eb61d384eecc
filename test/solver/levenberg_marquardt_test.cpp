#include "tartan_calib/solver/levenberg_marquardt.h"

#include <gtest/gtest.h>

#include <cmath>

#include "random_problem.h"
#include "support/derivative_check.h"

namespace tartan_calib::solver {
namespace {

/// Rosenbrock's valley, r = (steepness (y - x^2), 1 - x), with an own unknown of one block that wants to be x.
class Rosenbrock : public BlockProblem {
 public:
  double x = -1.2;
  double y = 1.0;
  double max_x = std::numeric_limits<double>::infinity();
  double b = 0.0;
  double steepness = 10.0;
  double floor = 0.0;  ///< a residual that nothing changes

  int numShared() const override { return 2; }
  int numBlocks() const override { return 1; }
  StepLimits stepLimits() const override {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    return {Eigen::Vector2d(-kInfinity, -kInfinity), Eigen::Vector2d(max_x - x, kInfinity)};
  }
  double cost(int /*block*/) const override { return 0.5 * (residuals().squaredNorm() + floor * floor); }
  BlockTerms linearize(int /*block*/) const override {
    Eigen::Matrix<double, 3, 2> J_s;
    J_s << -2.0 * steepness * x, steepness, -1.0, 0.0, 1.0, 0.0;
    const Eigen::Vector3d J_b(0.0, 0.0, -1.0);
    BlockTerms terms;
    terms.cost = cost(0);
    terms.shared = {0, 1};
    terms.H_ss = J_s.transpose() * J_s;
    terms.g_s = J_s.transpose() * residuals();
    terms.H_bs = BlockRows::Zero(kBlockSize, 2);
    terms.H_bs.row(0) = J_b.transpose() * J_s;
    terms.H_bb(0, 0) = J_b.squaredNorm();
    terms.g_b(0) = J_b.dot(residuals());
    return terms;
  }
  void move(const Step& step) override {
    x = std::min(max_x, x + step.shared(0));
    y += step.shared(1);
    b += step.blocks[0](0);
  }
  void save() override { saved_ = {x, y, b}; }
  void restore() override {
    x = saved_.x();
    y = saved_.y();
    b = saved_.z();
  }

 private:
  Eigen::Vector3d residuals() const { return {steepness * (y - x * x), 1.0 - x, x - b}; }

  Eigen::Vector3d saved_;
};

/// The default tolerance promises the cost to 1e-12, unknowns to about its root.
constexpr double kAccuracy = 1e-6;

class BothSolvers : public testing::TestWithParam<LinearSolver> {
 protected:
  static Options options() {
    Options options;
    options.linear_solver = GetParam();
    options.absolute_tolerance = 1e-24;
    return options;
  }
};

INSTANTIATE_TEST_SUITE_P(LinearSolver, BothSolvers, testing::Values(LinearSolver::kSchur, LinearSolver::kSparse),
                         [](const auto& test) { return test.param == LinearSolver::kSchur ? "schur" : "sparse"; });

TEST_P(BothSolvers, FindRosenbrocksMinimum) {
  Rosenbrock problem;
  const Summary summary = minimize(problem, options());
  EXPECT_EQ(summary.status, Status::kConverged);
  EXPECT_NEAR(problem.x, 1.0, 1e-9);
  EXPECT_NEAR(problem.y, 1.0, 1e-9);
  EXPECT_NEAR(problem.b, 1.0, 1e-9);
}

TEST_P(BothSolvers, StopAtABoundAndLetTheOthersAdapt) {
  Rosenbrock problem;
  problem.max_x = 0.5;
  const Summary summary = minimize(problem, options());
  EXPECT_EQ(summary.status, Status::kConverged);
  EXPECT_EQ(problem.x, 0.5);
  EXPECT_NEAR(problem.y, 0.25, kAccuracy);
  EXPECT_NEAR(problem.b, 0.5, kAccuracy);
}

TEST_P(BothSolvers, LeaveABoundThatTheMinimumDoesNotTouch) {
  RandomProblem free({});
  minimize(free, options());
  RandomProblem bounded({});
  for (int i = 0; i < bounded.numShared(); ++i) {
    // Starts on a bound from which the minimum lies inwards.
    bounded.setBounds(i, free.shared()(i) > 0.0 ? 0.0 : -10.0, free.shared()(i) > 0.0 ? 10.0 : 0.0);
  }
  EXPECT_EQ(minimize(bounded, options()).status, Status::kConverged);
  EXPECT_LT((bounded.shared() - free.shared()).norm(), kAccuracy);
}

TEST_P(BothSolvers, SolveLinearLeastSquaresExactly) {
  RandomProblemOptions linear;
  linear.bend = 0.0;
  RandomProblem problem(linear);
  const Eigen::VectorXd expected = -inverseNormalMatrix(problem) * denseSystem(problem).g;
  EXPECT_EQ(minimize(problem, options()).status, Status::kConverged);
  EXPECT_LT((problem.shared() - expected.head(problem.numShared())).norm(), 1e-9);
  for (int k = 0; k < problem.numBlocks(); ++k) {
    const auto own = expected.segment<kBlockSize>(problem.numShared() + kBlockSize * k);
    EXPECT_LT((problem.own()[static_cast<std::size_t>(k)] - own).norm(), 1e-9);
  }
}

TEST_P(BothSolvers, LeaveUndeterminedUnknownsWhereTheyAre) {
  RandomProblemOptions sizes;
  RandomProblem problem(sizes);
  for (RandomProblem::Block& block : problem.blocks) {
    for (int i = 0; i < sizes.num_touched; ++i) {
      if (block.touched[static_cast<std::size_t>(i)] == 3) {
        block.A.col(i).setZero();
      }
    }
  }
  problem.blocks[5].A.setZero();
  problem.blocks[5].B.setZero();
  const Summary summary = minimize(problem, options());
  EXPECT_EQ(summary.status, Status::kConverged);
  EXPECT_TRUE(problem.shared().allFinite());
  EXPECT_EQ(problem.shared()(3), 0.0);
  EXPECT_EQ(problem.own()[5].norm(), 0.0);
  const DenseSystem dense = denseSystem(problem);
  EXPECT_LT(dense.g.norm(), kAccuracy * dense.H.norm());
}

TEST(LevenbergMarquardt, SchurAndSparseAgree) {
  RandomProblemOptions sizes;
  sizes.num_blocks = 100;
  RandomProblem schur(sizes);
  RandomProblem sparse(sizes);
  for (RandomProblem* problem : {&schur, &sparse}) {
    problem->setBounds(2, -0.001, 0.001);
    Options options;
    options.linear_solver = problem == &schur ? LinearSolver::kSchur : LinearSolver::kSparse;
    minimize(*problem, options);
  }
  EXPECT_LT((schur.shared() - sparse.shared()).norm(), 1e-10);
  EXPECT_EQ(std::abs(schur.shared()(2)), 0.001);
}

TEST(LevenbergMarquardt, GivesTheSameBitsForAnyNumberOfThreads) {
  const auto solved = [](int num_threads) {
    RandomProblem problem({});
    Options options;
    options.num_threads = num_threads;
    minimize(problem, options);
    return problem.shared();
  };
  const Eigen::VectorXd one = solved(1);
  EXPECT_TRUE((solved(2).array() == one.array()).all());
  EXPECT_TRUE((solved(3).array() == one.array()).all());
}

TEST(LevenbergMarquardt, NeverRaisesTheCost) {
  Rosenbrock problem;
  double last_cost = problem.cost(0);
  Options options;
  options.progress = [&](int /*iteration*/, double cost) {
    EXPECT_LT(cost, last_cost);
    last_cost = cost;
    return true;
  };
  const Summary summary = minimize(problem, options);
  EXPECT_EQ(summary.final_cost, last_cost);
  EXPECT_GT(summary.iterations, 3);
}

TEST(LevenbergMarquardt, StopsWhenAskedTo) {
  Rosenbrock problem;
  Options options;
  options.progress = [](int iteration, double /*cost*/) { return iteration < 2; };
  const Summary summary = minimize(problem, options);
  EXPECT_EQ(summary.status, Status::kCancelled);
  EXPECT_EQ(summary.iterations, 2);
}

TEST(LevenbergMarquardt, FollowsANarrowCurvedValley) {
  // Damped steps that never climb its sides take 223. Above a floor its minimum looks near from everywhere.
  constexpr int kMaxIterations = 30;
  for (const double floor : {0.0, 3000.0}) {
    Rosenbrock problem;
    problem.steepness = 100.0;
    problem.floor = floor;
    Options options;
    options.max_iterations = kMaxIterations;
    options.relative_tolerance = 1e-15;
    options.negligible_ratio = 1e-13;
    const Summary summary = minimize(problem, options);
    EXPECT_EQ(summary.status, Status::kConverged) << floor;
    EXPECT_NEAR(problem.x, 1.0, 1e-3) << floor;
  }
}

/// r = (x, floor + bend x^2), whose second derivative J'J does not know, and normal equations that may overstate it.
class Bowl : public BlockProblem {
 public:
  double x = 0.1;
  double floor = 10.0;
  double bend = 0.0;
  double stiffness = 1.0;  ///< J'J is stated so many times too large

  int numShared() const override { return 1; }
  int numBlocks() const override { return 1; }
  StepLimits stepLimits() const override {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    return {Eigen::VectorXd::Constant(1, -kInfinity), Eigen::VectorXd::Constant(1, kInfinity)};
  }
  double cost(int /*block*/) const override { return 0.5 * residuals().squaredNorm(); }
  BlockTerms linearize(int /*block*/) const override {
    const Eigen::Vector2d J(1.0, 2.0 * bend * x);
    BlockTerms terms;
    terms.cost = cost(0);
    terms.shared = {0};
    terms.H_ss = stiffness * J.transpose() * J;
    terms.g_s = J.transpose() * residuals();
    terms.H_bs = BlockRows::Zero(kBlockSize, 1);
    return terms;
  }
  void move(const Step& step) override { x += step.shared(0); }
  void save() override { saved_ = x; }
  void restore() override { x = saved_; }

 private:
  Eigen::Vector2d residuals() const { return {x, floor + bend * x * x}; }

  double saved_ = 0.0;
};

TEST(LevenbergMarquardt, ShortensStepsThatSwingAboutTheMinimum) {
  // The curvature is 1.9 times J'J: whole steps leave 0.9 of the distance, on the other side, and take 60.
  constexpr int kMaxIterations = 5;
  Bowl problem;
  problem.bend = 0.045;
  Options options;
  options.max_iterations = kMaxIterations;
  EXPECT_EQ(minimize(problem, options).status, Status::kConverged);
  EXPECT_NEAR(problem.x, 0.0, std::sqrt(2.0 * options.relative_tolerance * problem.cost(0)));
}

TEST(LevenbergMarquardt, EndsWhereIterationsTogetherGainNothingThatCounts) {
  Bowl problem;
  problem.stiffness = 1000.0;  // each step goes a thousandth of the way
  Options options;
  options.negligible_ratio = 1e-5;
  const Summary summary = minimize(problem, options);
  EXPECT_EQ(summary.status, Status::kConverged);
  EXPECT_LT(summary.iterations, options.max_iterations / 2);

  Bowl other;
  other.stiffness = problem.stiffness;
  options.negligible_ratio = 0.0;
  EXPECT_EQ(minimize(other, options).status, Status::kMaxIterations);
}

TEST(LevenbergMarquardt, TakesADampedStepForANewtonStepUpToTheDampingThatCountsAsNone) {
  Options options;
  options.initial_damping = options.newton_damping = 100.0;
  options.relative_tolerance = 1e-5;
  Bowl problem;  // an undamped step would gain 1e-4 of the cost, this one a hundredth of it
  EXPECT_EQ(minimize(problem, options).iterations, 0);
  options.newton_damping = 1e-9;
  EXPECT_GT(minimize(problem, options).iterations, 0);
}

TEST(LevenbergMarquardt, SaysWhenIterationsRunOut) {
  Rosenbrock problem;
  Options options;
  options.max_iterations = 2;
  EXPECT_EQ(minimize(problem, options).status, Status::kMaxIterations);
}

/// States a slope that the cost does not have.
class WrongJacobian : public RandomProblem {
 public:
  using RandomProblem::RandomProblem;
  double slope_error = 1.0;

  BlockTerms linearize(int k) const override {
    BlockTerms terms = RandomProblem::linearize(k);
    terms.g_s(0) += slope_error;
    return terms;
  }
};

TEST(LevenbergMarquardt, ReportsThatItStallsWhereAWrongJacobianPointsUphill) {
  WrongJacobian problem{RandomProblemOptions()};
  problem.slope_error = 0.0;
  ASSERT_EQ(minimize(problem, {}).status, Status::kConverged);
  problem.slope_error = 1.0;
  EXPECT_EQ(minimize(problem, {}).status, Status::kStalled);
}

TEST(LevenbergMarquardt, CountsAsConvergedWhereWhatFailedStepsPromiseIsNegligible) {
  for (const double negligible_ratio : {1e-3, 0.0}) {
    WrongJacobian problem{RandomProblemOptions()};
    problem.slope_error = 0.0;
    minimize(problem, {});
    problem.slope_error = 1e-2;
    Options options;
    options.negligible_ratio = negligible_ratio;
    EXPECT_EQ(minimize(problem, options).status, negligible_ratio > 0.0 ? Status::kConverged : Status::kStalled);
  }
}

TEST(DerivativeCheck, TellsARightJacobianFromAWrongOne) {
  constexpr double kStep = 1e-5;
  RandomProblem right({});
  WrongJacobian wrong{RandomProblemOptions()};
  EXPECT_LT(test_support::gradientError(right, kStep), 1e-6);
  EXPECT_GT(test_support::gradientError(wrong, kStep), 1e-3);
}

}  // namespace
}  // namespace tartan_calib::solver
