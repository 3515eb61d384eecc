#include "tartan_calib/calibration/solve.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/simulated_scene.h"
#include "tartan_calib/error.h"

namespace tartan_calib::calibration {
namespace {

using test_support::Random;
using test_support::Scene;
using test_support::SceneOptions;

constexpr int kWidth = 1224;
constexpr int kHeight = 1024;

geometry::Rigid3 randomMotion(Random& random, double sigma_m, double sigma_rad) {
  geometry::Vector6d xi;
  for (int i = 0; i < 6; ++i) {
    xi(i) = test_support::normal(random, i < 3 ? sigma_m : sigma_rad);
  }
  return geometry::expRigid(xi);
}

/// Cameras side by side, each turned a little, all of one kind.
Rig rowOfCameras(const std::vector<std::string>& models, double fov_rad, Random& random) {
  Rig rig;
  for (const std::string& model : models) {
    const double i = static_cast<double>(rig.cameras.size());
    geometry::Vector6d xi;
    xi << -0.1 * i, 0.01 * i, 0.005 * i, 0.02 * i, 0.1 * i, -0.03 * i;
    rig.cameras.push_back({test_support::randomCamera(model, fov_rad, kWidth, kHeight, random), geometry::expRigid(xi)});
  }
  return rig;
}

Problem exactProblem(const Scene& scene) {
  return {scene.target_points, scene.views, scene.rig, scene.T_rig_target, Eigen::Vector2d::Zero()};
}

/// Moves all start values off the truth, as far as a start without images of the solver's quality would.
void disturbStart(Problem& problem, Random& random) {
  for (std::size_t i = 0; i < problem.rig.cameras.size(); ++i) {
    camera::CameraModel& model = problem.rig.cameras[i].camera.model;
    Eigen::VectorXd parameters = camera::parameters(model);
    const int focal = camera::focalIndex(model);
    parameters.segment<2>(focal) *= 1.02;
    parameters.segment<2>(focal + 2) += Eigen::Vector2d(4.0, -3.0);
    model = camera::withParameters(model, parameters);
    if (i > 0) {
      problem.rig.cameras[i].T_cam_rig = randomMotion(random, 0.005, 0.005) * problem.rig.cameras[i].T_cam_rig;
    }
  }
  for (geometry::Rigid3& T_rig_target : problem.T_rig_target) {
    T_rig_target = randomMotion(random, 0.01, 0.01) * T_rig_target;
  }
}

class EveryModel : public testing::TestWithParam<std::string> {};

double widestFov(const std::string& model) {
  return model == "pinhole-none" || model == "pinhole-radtan" ? 1.4 : model == "pinhole-fov" ? 2.6 : 3.2;
}

TEST_P(EveryModel, ExactCornersGiveTheExactCamera) {
  Random random(7);
  SceneOptions options;
  options.num_views = 30;
  const Scene scene = test_support::simulateScene(rowOfCameras({GetParam()}, widestFov(GetParam()), random), options);
  Problem problem = exactProblem(scene);
  disturbStart(problem, random);
  const Solution solution = solve(problem, {});

  EXPECT_EQ(solution.status, SolveStatus::kConverged);
  EXPECT_LT(solution.sigma_px, 1e-7);
  const Eigen::VectorXd truth = camera::parameters(scene.rig.cameras[0].camera.model);
  const Eigen::VectorXd found = camera::parameters(solution.rig.cameras[0].camera.model);
  EXPECT_LT(((found - truth).array() / truth.array().abs().max(1.0)).abs().maxCoeff(), 1e-6) << found.transpose();
  for (std::size_t k = 0; k < scene.views.size(); ++k) {
    EXPECT_LT(geometry::logRigid(solution.T_rig_target[k] * scene.T_rig_target[k].inverse()).norm(), 1e-6);
  }
}

INSTANTIATE_TEST_SUITE_P(Solve, EveryModel, testing::ValuesIn(camera::modelNames()), [](const auto& test) {
  std::string name = test.param;
  name[name.find('-')] = '_';
  return name;
});

TEST(Solve, ResidualStdevIsTheInjectedNoise) {
  constexpr double kNoise_px = 0.2;
  Random random(3);
  Scene scene = test_support::simulateScene(rowOfCameras({"ds-none", "pinhole-equi"}, 2.8, random), {});
  test_support::addNoise(scene.views, kNoise_px, 5);
  Problem problem = exactProblem(scene);
  disturbStart(problem, random);
  SolveOptions options;
  options.remove_outliers = false;
  const Solution solution = solve(problem, options);
  EXPECT_EQ(solution.status, SolveStatus::kConverged);
  EXPECT_NEAR(solution.sigma_px, kNoise_px, 0.05 * kNoise_px);
}

}  // namespace
}  // namespace tartan_calib::calibration
