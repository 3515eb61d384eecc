#include "../../src/calibration/residual_block.h"

#include <gtest/gtest.h>

#include <cmath>

#include "../../src/calibration/batch_problem.h"
#include "solve_scenes.h"
#include "support/derivative_check.h"

namespace tartan_calib::calibration {
namespace {

class ResidualsOfEveryModel : public testing::TestWithParam<std::string> {};

INSTANTIATE_TEST_SUITE_P(ResidualBlock, ResidualsOfEveryModel, testing::ValuesIn(camera::modelNames()),
                         [](const auto& test) { return testName(test.param); });

/// A rig of two cameras that see a bent board with noise of different size along different directions.
Problem richProblem(const std::string& model) {
  Random random(11);
  SceneOptions options;
  options.num_views = 3;
  options.max_corners = 40;
  options.max_polar_angle_rad = 1.2;  // far from where a step of the parameters takes a corner's image away
  Problem problem = noisyProblem(test_support::simulateScene(rowOfCameras({model, "ds-none"}, random), options), 0.5, 1);
  test_support::forEachCorner(problem.views, [&](observation::Corner& corner) {
    const double shear = test_support::uniform(random, -0.5, 0.5);
    corner.cov_px2 << 1.0, shear, shear, 2.0;
  });
  problem.board_warp_m = {0.001, -0.002};
  problem.rig.cameras[0].camera.pupil.coefficients_m = {0.01, -0.003};
  return problem;
}

TEST_P(ResidualsOfEveryModel, GradientEqualsCentralDifferencesForPosesRigIntrinsicsPupilsAndWarp) {
  constexpr double kStep = 1e-6;       // metres, radians and pixels alike: rounding and curvature both stay below
  constexpr double kTolerance = 1e-6;  // rounding of the cost over that step
  SolveOptions options;
  options.estimate_board_warp = true;
  options.estimate_pupil_shift = true;
  for (const RobustLoss loss : {RobustLoss{RobustLoss::Kind::kLeastSquares, 1.0}, RobustLoss{RobustLoss::Kind::kCauchy, 0.7},
                                RobustLoss{RobustLoss::Kind::kBlakeZisserman, 1.0}}) {
    const Problem problem = richProblem(GetParam());
    BatchProblem batch(problem, options);
    batch.setLosses({loss, loss});
    EXPECT_EQ(batch.numShared(), 6 + camera::numParameters(problem.rig.cameras[0].camera.model) + 6 + 2 * 2 + 2);
    EXPECT_LT(test_support::gradientError(batch, kStep), kTolerance);
  }
}

TEST_P(ResidualsOfEveryModel, NormalMatrixIsTheJacobiansSquare) {
  // For a change d along any unknown, the residuals of exact corners change by J d, the cost by d'Hd / 2.
  constexpr double kStep = 1e-4;
  Problem problem = richProblem(GetParam());
  problem.board_warp_m.setZero();
  for (std::size_t k = 0; k < problem.views.size(); ++k) {
    for (observation::CameraView& image : problem.views[k].cameras) {
      for (observation::Corner& corner : image.corners) {
        corner.px -=
            *residual(problem.rig, problem.T_rig_target[k],
                      problem.target_points[static_cast<std::size_t>(corner.corner_id)], image.camera_index, corner.px);
      }
    }
  }
  SolveOptions options;
  options.estimate_board_warp = true;
  options.estimate_pupil_shift = true;
  BatchProblem batch(problem, options);
  const Eigen::VectorXd diagonal = test_support::statedDerivatives(batch).diagonal;
  for (Eigen::Index i = 0; i < diagonal.size(); ++i) {
    const Eigen::VectorXd step = kStep * Eigen::VectorXd::Unit(diagonal.size(), i);
    const double cost = 0.5 * (test_support::costAfter(batch, step) + test_support::costAfter(batch, -step));
    EXPECT_NEAR(cost / (0.5 * kStep * kStep * diagonal(i)), 1.0, 1e-3) << "unknown " << i;
  }
}

TEST(RobustLoss, WeightIsTheSlopeOfRho) {
  constexpr double kStep = 1e-6;
  for (const RobustLoss loss : {RobustLoss{RobustLoss::Kind::kLeastSquares, 1.0}, RobustLoss{RobustLoss::Kind::kCauchy, 0.7},
                                RobustLoss{RobustLoss::Kind::kBlakeZisserman, 1.0}}) {
    EXPECT_NEAR(loss.rho(0.0), 0.0, 1e-15);
    for (const double s : {0.01, 0.5, 3.0, 10.0, 13.8, 30.0}) {
      EXPECT_NEAR(loss.weight(s), (loss.rho(s + kStep) - loss.rho(s - kStep)) / (2.0 * kStep), 1e-8) << "s = " << s;
    }
  }
}

TEST(RobustLoss, BlakeZissermanHasKalibrsWeights) {
  const RobustLoss loss{RobustLoss::Kind::kBlakeZisserman, 1.0};
  EXPECT_NEAR(loss.weight(0.0), 1.0, 1e-4);
  EXPECT_NEAR(loss.weight(13.816), 0.1, 1e-4);
  EXPECT_TRUE(std::isfinite(loss.rho(1e9)));
  EXPECT_GE(loss.weight(1e9), 0.0);
}

/// One camera, one corner on the axis, which the pinhole sees at its principal point.
struct OneCorner {
  std::vector<Eigen::Vector3d> points = {{0.0, 0.0, 0.0}, {1.0, 1.0, 0.0}};
  WarpedBoard board{points};
  camera::Camera camera{camera::startModel(camera::modelByName("pinhole-none"), 500.0, {320.0, 240.0}), 640, 480};
  CameraMeasurements measurements{
      0, {{0, {320.0, 240.0}, Eigen::Matrix2d::Identity(), Eigen::Matrix2d::Identity(), CornerState::kUsed}}};

  double cost(const Eigen::Vector3d& t_cam_target, const RobustLoss& loss) const {
    return blockCost({measurements, board, camera, geometry::Rigid3(Eigen::Quaterniond::Identity(), t_cam_target), loss});
  }
};

TEST(ResidualBlock, LeavingTheModelsDomainNeverPays) {
  const OneCorner one;
  const Eigen::Vector3d behind(0.0, 0.0, -1.0);
  for (const RobustLoss loss :
       {RobustLoss{}, RobustLoss{RobustLoss::Kind::kCauchy, 0.1}, RobustLoss{RobustLoss::Kind::kBlakeZisserman, 1.0}}) {
    const double escaped = one.cost(behind, loss);
    for (const double x_m : {0.0, 0.1, 0.5, 1.0}) {  // up to 500 px off, the image's diagonal is 800
      EXPECT_GE(escaped, one.cost({x_m, 0.0, 1.0}, loss)) << "x = " << x_m;
    }
  }
}

TEST(ResidualBlock, CornersWithoutImageCostTheSameInBothEvaluations) {
  const OneCorner one;
  const ResidualBlock block{one.measurements, one.board, one.camera,
                            geometry::Rigid3(Eigen::Quaterniond::Identity(), Eigen::Vector3d(0.0, 0.0, -1.0)), RobustLoss{}};
  const LocalTerms terms = linearizeBlock(block, {true, true});
  EXPECT_EQ(terms.cost, blockCost(block));
  EXPECT_EQ(terms.g.norm(), 0.0);
  EXPECT_EQ(terms.H.norm(), 0.0);
  EXPECT_FALSE(blockErrors(block)[0].has_value());
}

TEST(WarpedBoard, BendsTheMiddleAndLeavesTheCorners) {
  const std::vector<Eigen::Vector3d> points = {{0.0, 0.0, 0.0}, {0.5, 0.2, 0.0}, {1.0, 0.4, 0.0}, {0.5, 0.0, 0.0}};
  const std::vector<Eigen::Vector3d> bent = warpedPoints(points, {0.003, 0.001});
  EXPECT_NEAR(bent[0].z(), 0.0, 1e-15);
  EXPECT_NEAR(bent[1].z(), 0.004, 1e-15);
  EXPECT_NEAR(bent[2].z(), 0.0, 1e-15);
  EXPECT_NEAR(bent[3].z(), 0.003, 1e-15);
}

}  // namespace
}  // namespace tartan_calib::calibration
