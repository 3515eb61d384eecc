#include "tartan_calib/calibration/information.h"

#include <gtest/gtest.h>

#include <Eigen/LU>

#include "support/simulated_scene.h"
#include "tartan_calib/calibration/solve.h"

namespace tartan_calib::calibration {
namespace {

using test_support::Scene;

constexpr int kNumShared = 6 + 6 + 6;  // T_cam1_rig and the parameters of two cameras of ds-none

Scene stereoScene(int num_views) {
  test_support::Random random(5);
  Rig rig;
  rig.cameras.push_back({test_support::randomCamera("ds-none", 2.6, 800, 600, random), geometry::Rigid3()});
  rig.cameras.push_back({test_support::randomCamera("ds-none", 2.6, 800, 600, random),
                         geometry::Rigid3(Eigen::Quaterniond::Identity(), Eigen::Vector3d(-0.1, 0.0, 0.01))});
  test_support::SceneOptions options;
  options.num_views = num_views;
  Scene scene = test_support::simulateScene(rig, options);
  test_support::addNoise(scene.views, 1e-4, 3);  // so small that the solve stays at the truth
  return scene;
}

Solution solveFirst(const Scene& scene, std::size_t num_views) {
  Problem problem;
  problem.target_points = scene.target_points;
  problem.rig = scene.rig;
  problem.views.assign(scene.views.begin(), scene.views.begin() + static_cast<std::ptrdiff_t>(num_views));
  problem.T_rig_target.assign(scene.T_rig_target.begin(),
                              scene.T_rig_target.begin() + static_cast<std::ptrdiff_t>(num_views));
  SolveOptions options;
  options.anneal_robust_loss = false;
  options.remove_outliers = false;
  options.final_filtering = false;
  options.num_threads = 1;
  return solve(problem, options);
}

Eigen::MatrixXd informationOf(const Scene& scene, std::size_t first, std::size_t last) {
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(kNumShared, kNumShared);
  for (std::size_t i = first; i < last; ++i) {
    sum += viewInformation(scene.rig, scene.target_points, scene.views[i], scene.T_rig_target[i]);
  }
  return sum;
}

double log2Determinant(const Eigen::MatrixXd& matrix) { return std::log2(matrix.determinant()); }

TEST(ViewInformation, SumsToTheInverseOfTheSolvedCovariance) {
  const Scene scene = stereoScene(12);
  const Solution solution = solveFirst(scene, scene.views.size());
  ASSERT_EQ(solution.covariance.rows(), kNumShared);
  const Eigen::MatrixXd covariance = solution.covariance / (solution.sigma_whitened * solution.sigma_whitened);
  const Eigen::MatrixXd expected = informationOf(scene, 0, scene.views.size()).inverse();
  const Eigen::MatrixXd intrinsics = covariance.bottomRightCorner(12, 12);
  const Eigen::MatrixXd difference = expected.bottomRightCorner(12, 12) - intrinsics;
  const Eigen::VectorXd scale = intrinsics.diagonal().cwiseSqrt().cwiseInverse();  // parameters have different units
  EXPECT_LT((scale.asDiagonal() * difference * scale.asDiagonal()).cwiseAbs().maxCoeff(), 1e-4);
}

TEST(ViewInformation, OfOneMoreViewIsWhatSolvingWithItGains) {
  const Scene scene = stereoScene(13);
  const std::size_t num_before = scene.views.size() - 1;
  const Solution before = solveFirst(scene, num_before);
  const Solution after = solveFirst(scene, scene.views.size());
  const auto bits = [](const Solution& solution) {
    return -0.5 * log2Determinant(solution.covariance / (solution.sigma_whitened * solution.sigma_whitened));
  };
  const double expected = 0.5 * (log2Determinant(informationOf(scene, 0, num_before + 1)) -
                                 log2Determinant(informationOf(scene, 0, num_before)));
  EXPECT_GT(expected, 0.1);
  EXPECT_NEAR(bits(after) - bits(before), expected, 1e-4);
}

TEST(ViewInformation, IsZeroWhereTheViewDeterminesNoPose) {
  const Scene scene = stereoScene(1);
  observation::View view = scene.views.front();
  view.cameras.resize(1);
  view.cameras.front().corners.resize(2);
  EXPECT_EQ(viewInformation(scene.rig, scene.target_points, view, scene.T_rig_target.front()).norm(), 0.0);
}

}  // namespace
}  // namespace tartan_calib::calibration
