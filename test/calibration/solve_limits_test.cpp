#include <gtest/gtest.h>

#include <cmath>

#include "solve_scenes.h"
#include "tartan_calib/calibration/solve.h"
#include "tartan_calib/error.h"

namespace tartan_calib::calibration {
namespace {

TEST(Solve, StopsAtABoundAndSaysSo) {
  // A lens without distortion is EUCM with alpha = 0, the edge of its domain, where beta means nothing.
  const Scene scene = sceneOf({"pinhole-none"}, 20);
  Problem problem = noisyProblem(scene, kNoise_px, 5);
  const Eigen::VectorXd pinhole = parametersOf(scene.rig, 0);
  Eigen::VectorXd eucm(6);
  eucm << 0.1, 1.0, pinhole;
  problem.rig.cameras[0].camera.model = camera::withParameters(camera::modelByName("eucm-none"), eucm);
  const Solution solution = solve(problem, {});
  const Eigen::VectorXd found = parametersOf(solution.rig, 0);
  EXPECT_TRUE(found.allFinite());
  EXPECT_TRUE((found.array() >= camera::lowerBound(problem.rig.cameras[0].camera.model).array()).all());
  EXPECT_TRUE((found.array() <= camera::upperBound(problem.rig.cameras[0].camera.model).array()).all());
  EXPECT_TRUE(solution.covariance.allFinite());
  EXPECT_NEAR(solution.sigma_px, kNoise_px, 0.1 * kNoise_px);
}

TEST(Solve, NamesACameraThatNothingDetermines) {
  Scene scene = sceneOf({"ds-none", "ds-none"}, 20);
  for (observation::View& view : scene.views) {
    view.cameras.resize(std::min<std::size_t>(1, view.cameras.size()));
  }
  Problem problem = noisyProblem(scene, kNoise_px, 5);
  for (observation::View& view : problem.views) {
    if (!view.cameras.empty() && view.cameras[0].camera_index == 1) {
      view.cameras.clear();
    }
  }
  const Solution solution = solve(problem, {});
  EXPECT_EQ(solution.undetermined,
            (std::vector<std::string>{"cam1 extrinsics", "cam1 projection[0]", "cam1 projection[1]", "cam1 projection[2]",
                                      "cam1 projection[3]", "cam1 projection[4]", "cam1 projection[5]"}));
  EXPECT_TRUE(solution.covariance.allFinite());
  EXPECT_EQ(parametersOf(solution.rig, 1), parametersOf(scene.rig, 1));
  const Eigen::VectorXd error = parametersOf(solution.rig, 0) - parametersOf(scene.rig, 0);
  const Eigen::VectorXd sigma = solution.covariance.diagonal().segment(intrinsicsRow(scene.rig, 0), 6).cwiseSqrt();
  EXPECT_LT(error.cwiseQuotient(sigma).cwiseAbs().maxCoeff(), kMaxNormalisedError);
}

TEST(Solve, LeavesOutViewsWithTooFewCorners) {
  const Scene scene = sceneOf({"ds-none"}, 20);
  Problem problem = noisyProblem(scene, kNoise_px, 5);
  problem.views[3].cameras[0].corners.resize(3);
  problem.views[7].cameras.clear();
  Random random(1);
  disturbStart(problem, random);
  const Solution solution = solve(problem, {});
  EXPECT_EQ(solution.unsolved_views, (std::vector<int>{3, 7}));
  EXPECT_EQ(solution.counts[0].unsupported, 3);
  EXPECT_FALSE(solution.views[3].cameras[0].corners[0].used);
  EXPECT_EQ(solution.T_rig_target[3].matrix(), problem.T_rig_target[3].matrix());
  EXPECT_EQ(solution.T_rig_target[7].matrix(), problem.T_rig_target[7].matrix());
  EXPECT_LT(normalisedErrors(solution, scene.rig).abs().maxCoeff(), kMaxNormalisedError);
}

TEST(Solve, CountsCornersWithoutImage) {
  const Scene scene = sceneOf({"pinhole-radtan"}, 20);
  Problem problem = noisyProblem(scene, kNoise_px, 5);
  // The board of view 0 passes through the camera's plane: the corners behind it cannot have been seen.
  problem.T_rig_target[0] = geometry::Rigid3(Eigen::Quaterniond(Eigen::AngleAxisd(M_PI / 2, Eigen::Vector3d::UnitY())),
                                             Eigen::Vector3d(0.1, 0.0, 0.4));
  observation::CameraView seen =
      test_support::visibleCorners(scene.rig.cameras[0].camera, scene.target_points, problem.T_rig_target[0], M_PI);
  std::vector<observation::Corner>& corners = problem.views[0].cameras[0].corners;
  corners.clear();
  int num_behind = 0;
  for (std::size_t id = 0; id < scene.target_points.size(); ++id) {
    const Eigen::Vector3d p_cam = problem.T_rig_target[0] * scene.target_points[id];
    const auto px = camera::project(scene.rig.cameras[0].camera.model, p_cam);
    if (px && camera::isInside(scene.rig.cameras[0].camera, *px)) {
      corners.push_back({static_cast<int>(id), *px});
    } else if (!px && num_behind < 5) {
      corners.push_back({static_cast<int>(id), Eigen::Vector2d(600.0, 500.0)});
      ++num_behind;
    }
  }
  ASSERT_EQ(num_behind, 5);
  const Solution solution = solve(problem, {});
  EXPECT_EQ(solution.status, SolveStatus::kConverged);
  EXPECT_EQ(solution.counts[0].unprojectable, num_behind);
  EXPECT_LT(normalisedErrors(solution, scene.rig).abs().maxCoeff(), kMaxNormalisedError);
}

TEST(Solve, ReportsProgressAndStopsWhenAskedTo) {
  const Scene scene = sceneOf({"ds-none"}, 10);
  Problem problem = noisyProblem(scene, kNoise_px, 5);
  Random random(1);
  disturbStart(problem, random);
  SolveOptions options;
  std::vector<SolveProgress> reports;
  options.progress = [&](const SolveProgress& progress) {
    reports.push_back(progress);
    return true;
  };
  const Solution solution = solve(problem, options);
  ASSERT_EQ(static_cast<int>(reports.size()), solution.iterations);
  EXPECT_EQ(reports.front().stage, 0);
  EXPECT_LT(reports.back().stage, reports.back().num_stages);
  double done_share = 0.0;
  for (const SolveProgress& report : reports) {
    EXPECT_GT(doneShare(report), done_share);
    done_share = doneShare(report);
  }
  EXPECT_GT(done_share, static_cast<double>(reports.back().stage) / reports.back().num_stages);
  EXPECT_LT(done_share, 1.0);
  EXPECT_NEAR(reports.back().rms_px, std::sqrt(2.0) * kNoise_px, 0.1 * kNoise_px);

  int num_calls = 0;
  options.progress = [&](const SolveProgress& /*progress*/) { return ++num_calls < 2; };
  EXPECT_EQ(solve(problem, options).status, SolveStatus::kCancelled);
  EXPECT_EQ(num_calls, 2);
}

TEST(Solve, RefusesContradictoryInput) {
  const Problem good = exactProblem(sceneOf({"ds-none"}, 3));
  const auto rejects = [&good](const auto& damage) {
    Problem bad = good;
    damage(bad);
    EXPECT_THROW(solve(bad, {}), Error);
  };
  rejects([](Problem& bad) { bad.T_rig_target.pop_back(); });
  rejects([](Problem& bad) { bad.views[0].cameras[0].camera_index = 1; });
  rejects([](Problem& bad) { bad.views[0].cameras[0].corners[0].corner_id = 144; });
  rejects([](Problem& bad) { bad.views[0].cameras[0].corners[0].px.x() = std::nan(""); });
  rejects([](Problem& bad) { bad.views[0].cameras[0].corners[0].cov_px2.setZero(); });
  rejects([](Problem& bad) {
    for (observation::View& view : bad.views) {
      view.cameras.clear();
    }
  });
}

}  // namespace
}  // namespace tartan_calib::calibration
