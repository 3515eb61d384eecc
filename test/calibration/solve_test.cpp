#include "tartan_calib/calibration/solve.h"

#include <gtest/gtest.h>

#include <cmath>

#include "solve_scenes.h"
#include "tartan_calib/calibration/compare.h"
#include "tartan_calib/error.h"
#include "tartan_calib/geometry/linear_solve.h"

namespace tartan_calib::calibration {
namespace {

int totalUsed(const Solution& solution) {
  int used = 0;
  for (const CornerCounts& counts : solution.counts) {
    used += counts.used;
  }
  return used;
}

int numCorners(std::vector<observation::View> views) {
  int num_corners = 0;
  test_support::forEachCorner(views, [&](observation::Corner&) { ++num_corners; });
  return num_corners;
}

class SolveOfEveryModel : public testing::TestWithParam<std::string> {};

INSTANTIATE_TEST_SUITE_P(Solve, SolveOfEveryModel, testing::ValuesIn(camera::modelNames()),
                         [](const auto& test) { return testName(test.param); });

TEST_P(SolveOfEveryModel, ExactCornersGiveTheExactRig) {
  const Scene scene = sceneOf({GetParam(), "ds-none"}, 30);
  Problem problem = exactProblem(scene);
  Random random(1);
  disturbStart(problem, random);
  const Solution solution = solve(problem, {});

  EXPECT_EQ(solution.status, SolveStatus::kConverged);
  EXPECT_EQ(totalUsed(solution), numCorners(scene.views));
  EXPECT_LT(solution.sigma_px, 1e-7);
  const Eigen::VectorXd truth = parametersOf(scene.rig, 0);
  const Eigen::VectorXd found = parametersOf(solution.rig, 0);
  EXPECT_LT(((found - truth).array() / truth.array().abs().max(1.0)).abs().maxCoeff(), 1e-6) << found.transpose();
  EXPECT_LT(geometry::logRigid(baselineOf(solution.rig, 1) * baselineOf(scene.rig, 1).inverse()).norm(), 1e-7);
  for (std::size_t k = 0; k < scene.views.size(); ++k) {
    EXPECT_LT(geometry::logRigid(solution.T_rig_target[k] * scene.T_rig_target[k].inverse()).norm(), 1e-6);
  }
}

TEST_P(SolveOfEveryModel, NoiseGivesErrorsOfThePredictedSize) {
  const Scene scene = sceneOf({GetParam()}, 40);
  Problem problem = noisyProblem(scene, kNoise_px, 5);
  Random random(1);
  disturbStart(problem, random);
  const Solution solution = solve(problem, {});
  EXPECT_EQ(solution.status, SolveStatus::kConverged);
  EXPECT_NEAR(solution.sigma_px, kNoise_px, 0.1 * kNoise_px);
  EXPECT_EQ(solution.sigma_whitened, solution.sigma_px);
  EXPECT_LT(normalisedErrors(solution, scene.rig).abs().maxCoeff(), kMaxNormalisedError);
  EXPECT_TRUE(solution.undetermined.empty());
}

TEST(Solve, ErrorsFollowThePredictedCovarianceOverManyRecordings) {
  constexpr int kRecordings = 60;
  const Scene scene = sceneOf({"pinhole-radtan", "pinhole-equi", "ds-none"}, 12);
  double sum_of_chi_squares = 0.0;
  Eigen::Index num_parameters = 0;
  for (unsigned seed = 0; seed < kRecordings; ++seed) {
    SolveOptions options;
    options.remove_outliers = false;
    const Solution solution = solve(noisyProblem(scene, kNoise_px, 100 + seed), options);
    const Eigen::VectorXd error = errorVector(solution.rig, scene.rig);
    sum_of_chi_squares += error.dot(geometry::solveSymmetric(solution.covariance, error));
    num_parameters = error.size();
  }
  // Chi-square of kRecordings * num_parameters degrees of freedom, four of its stdevs.
  const double expected = static_cast<double>(kRecordings * num_parameters);
  EXPECT_NEAR(sum_of_chi_squares, expected, 4.0 * std::sqrt(2.0 * expected));
}

TEST(Solve, WeighsCornersByTheirCovariance) {
  constexpr int kRecordings = 30;
  const Scene scene = sceneOf({"ds-none"}, 10);
  double weighted_error2 = 0.0;
  double unweighted_error2 = 0.0;
  for (unsigned seed = 0; seed < kRecordings; ++seed) {
    Random random(seed);
    Problem problem = exactProblem(scene);
    test_support::forEachCorner(problem.views, [&](observation::Corner& corner) {
      // Blurred along one direction: four corners of five are good for little there.
      const double angle_rad = test_support::uniform(random, 0.0, M_PI);
      const Eigen::Matrix2d R = Eigen::Rotation2Dd(angle_rad).toRotationMatrix();
      const Eigen::Vector2d sigma_px(0.1, test_support::uniform(random, 0.0, 1.0) < 0.8 ? 1.0 : 0.1);
      corner.cov_px2 = R * sigma_px.cwiseAbs2().asDiagonal() * R.transpose();
      corner.px +=
          R * Eigen::Vector2d(test_support::normal(random, sigma_px.x()), test_support::normal(random, sigma_px.y()));
    });
    const Solution weighted = solve(problem, {});
    EXPECT_NEAR(weighted.sigma_whitened, 1.0, 0.1);
    EXPECT_LT(normalisedErrors(weighted, scene.rig).abs().maxCoeff(), kMaxNormalisedError);
    weighted_error2 += errorVector(weighted.rig, scene.rig).squaredNorm();
    test_support::forEachCorner(problem.views, [](observation::Corner& corner) { corner.cov_px2.setIdentity(); });
    unweighted_error2 += errorVector(solve(problem, {}).rig, scene.rig).squaredNorm();
  }
  EXPECT_LT(weighted_error2, 0.25 * unweighted_error2);
}

/// A disturbed start from noisy corners, of which a share is wrong.
struct WrongProblem {
  WrongProblem(const Scene& scene, double wrong_share)
      : problem(noisyProblem(scene, kNoise_px, 5)),
        num_wrong(test_support::addWrongCorners(problem.views, wrong_share, 20.0, 6)) {
    Random random(1);
    disturbStart(problem, random);
  }

  Problem problem;
  int num_wrong;
};

TEST(Solve, RejectsWrongCornersAndHardlyAnyOther) {
  const Scene scene = sceneOf({"ds-none", "omni-radtan"}, 50);
  const auto [problem, num_wrong] = WrongProblem(scene, 0.1);
  const Solution solution = solve(problem, {});
  EXPECT_EQ(solution.status, SolveStatus::kConverged);
  EXPECT_NEAR(solution.sigma_px, kNoise_px, 0.02 * kNoise_px);
  EXPECT_LT(normalisedErrors(solution, scene.rig).abs().maxCoeff(), kMaxNormalisedError);
  // A few wrong corners fall within four stdevs by chance, a few right ones beyond (1 of 8000).
  const int num_rejected = numCorners(scene.views) - totalUsed(solution);
  EXPECT_NEAR(num_rejected, num_wrong, 0.01 * num_wrong);
  EXPECT_EQ(numCorners(solution.views), numCorners(problem.views));
}

TEST(Solve, AStartFollowsTheRightCornersAndChoosesNone) {
  const Scene scene = sceneOf({"ds-none"}, 50);
  const Problem problem = WrongProblem(scene, 0.2).problem;
  SolveOptions options;
  const Solution complete = solve(problem, options);
  options.only_robust = true;
  const Solution start = solve(problem, options);
  EXPECT_EQ(start.counts[0].outliers, 0);
  EXPECT_EQ(start.covariance.size(), 0);
  EXPECT_LT(start.iterations, complete.iterations);
  const auto grid = imageGrid(scene.rig.cameras[0].camera.width, scene.rig.cameras[0].camera.height, 50.0);
  EXPECT_LT(compareProjections(scene.rig.cameras[0].camera.model, start.rig.cameras[0].camera.model, grid).rms_px,
            kNoise_px);
}

TEST(Solve, SurvivesWrongCornersInFiveViews) {
  const Scene scene = sceneOf({"ds-none"}, 5);
  const Solution solution = solve(WrongProblem(scene, 0.2).problem, {});
  EXPECT_LT(normalisedErrors(solution, scene.rig).abs().maxCoeff(), kMaxNormalisedError);
  EXPECT_GT(solution.counts[0].outliers, 0);
}

TEST(Solve, KeepsTheRimOfALensThatTheModelIsTooSimpleFor) {
  Eigen::VectorXd lens(6);
  lens << 0.867, 0.769, 633.0, 633.4, 615.4, 516.4;  // of 195 degrees
  SceneOptions options;
  options.num_views = 60;
  options.max_polar_angle_rad = 1.7;
  Rig rig;
  rig.cameras.push_back({{camera::withParameters(camera::modelByName("ds-none"), lens), 1224, 1024}, {}});
  const Scene scene = test_support::simulateScene(rig, options);
  constexpr double kSharp_px = 0.02;
  Problem problem = noisyProblem(scene, kSharp_px, 5);
  test_support::forEachCorner(problem.views, [](observation::Corner& corner) {
    corner.cov_px2 = kSharp_px * kSharp_px * Eigen::Matrix2d::Identity();
  });
  Eigen::VectorXd start(6);
  start << 0.6, 1.0, lens(2) / (1.0 + lens(0)), lens(3) / (1.0 + lens(0)), lens(4), lens(5);
  problem.rig.cameras[0].camera.model = camera::withParameters(camera::modelByName("eucm-none"), start);
  const Solution solution = solve(problem, {});
  ASSERT_GT(solution.sigma_px, 0.05);  // four of these are less than the misfit at the rim
  EXPECT_LT(numCorners(problem.views) - totalUsed(solution), 0.001 * numCorners(problem.views));
}

TEST(Solve, KeepsEveryCornerWhereOutliersShallStay) {
  const Scene scene = sceneOf({"ds-none"}, 25);
  Problem problem = noisyProblem(scene, kNoise_px, 5);
  test_support::addWrongCorners(problem.views, 0.05, 10.0, 6);
  SolveOptions options;
  options.remove_outliers = false;
  const Solution plain = solve(problem, options);
  EXPECT_EQ(totalUsed(plain), numCorners(problem.views));

  options.use_blake_zisserman = true;
  const Solution robust = solve(problem, options);
  EXPECT_EQ(totalUsed(robust), numCorners(problem.views));
  EXPECT_LT(errorVector(robust.rig, scene.rig).norm(), 0.5 * errorVector(plain.rig, scene.rig).norm());
}

TEST(Solve, FindsExtrinsicsThroughACameraInBetween) {
  Scene scene = sceneOf({"pinhole-radtan", "ds-none", "pinhole-equi"}, 90);
  // Neither cam0 and cam2 ever see the board together: one of them misses each view.
  for (std::size_t k = 0; k < scene.views.size(); ++k) {
    std::vector<observation::CameraView>& images = scene.views[k].cameras;
    const int missing = k % 2 == 0 ? 0 : 2;
    images.erase(std::remove_if(images.begin(), images.end(),
                                [missing](const observation::CameraView& image) { return image.camera_index == missing; }),
                 images.end());
  }
  Problem problem = noisyProblem(scene, 0.1, 5);
  Random random(1);
  disturbStart(problem, random);
  const Solution solution = solve(problem, {});
  for (const std::size_t i : {1U, 2U}) {
    const geometry::Rigid3& found = solution.rig.cameras[i].T_cam_rig;
    const geometry::Rigid3& truth = scene.rig.cameras[i].T_cam_rig;
    EXPECT_LT(found.rotation.angularDistance(truth.rotation), 0.2e-3) << "cam" << i;
    EXPECT_LT((found.translation - truth.translation).norm(), 0.3e-3) << "cam" << i;
  }
  // Also of the second baseline, whose uncertainty comes from both cameras' extrinsics.
  EXPECT_LT(normalisedErrors(solution, scene.rig).abs().maxCoeff(), kMaxNormalisedError);
}

TEST(Solve, DoesNotDependOnWhichCameraIsTheReference) {
  const Scene scene = sceneOf({"ds-none", "eucm-none"}, 20);
  const Problem problem = noisyProblem(scene, kNoise_px, 5);
  Problem swapped = problem;
  const geometry::Rigid3 T_cam1_cam0 = problem.rig.cameras[1].T_cam_rig;
  swapped.rig.cameras = {{problem.rig.cameras[1].camera, geometry::Rigid3()},
                         {problem.rig.cameras[0].camera, T_cam1_cam0.inverse()}};
  for (std::size_t k = 0; k < swapped.views.size(); ++k) {
    swapped.T_rig_target[k] = T_cam1_cam0 * problem.T_rig_target[k];
    for (observation::CameraView& image : swapped.views[k].cameras) {
      image.camera_index = 1 - image.camera_index;
    }
  }
  const Solution a = solve(problem, {});
  const Solution b = solve(swapped, {});
  // Both stop within a thousandth of a stdev of the same minimum.
  const Eigen::VectorXd sigma = a.covariance.diagonal().cwiseSqrt();
  const Eigen::VectorXd difference = parametersOf(a.rig, 0) - parametersOf(b.rig, 1);
  EXPECT_LT(difference.cwiseQuotient(sigma.segment(intrinsicsRow(a.rig, 0), difference.size())).cwiseAbs().maxCoeff(), 5e-3);
  EXPECT_LT(geometry::logRigid(baselineOf(a.rig, 1) * baselineOf(b.rig, 1)).norm(), 5e-3 * sigma.head<6>().norm());
  EXPECT_NEAR(a.sigma_px, b.sigma_px, 1e-6);
}

TEST(Solve, GivesTheSameBitsForAnyNumberOfThreads) {
  const Scene scene = sceneOf({"ds-none", "pinhole-equi"}, 40);
  Problem problem = noisyProblem(scene, kNoise_px, 5);
  test_support::addWrongCorners(problem.views, 0.02, 20.0, 6);
  const auto solved = [&](int num_threads) {
    SolveOptions options;
    options.num_threads = num_threads;
    return solve(problem, options);
  };
  const Solution one = solved(1);
  for (const int num_threads : {2, 3}) {
    const Solution many = solved(num_threads);
    for (int i = 0; i < 2; ++i) {
      EXPECT_TRUE((parametersOf(many.rig, i).array() == parametersOf(one.rig, i).array()).all());
    }
    EXPECT_TRUE((many.covariance.array() == one.covariance.array()).all());
    EXPECT_EQ(many.sigma_px, one.sigma_px);
    EXPECT_TRUE(many.T_rig_target.back().matrix() == one.T_rig_target.back().matrix());
  }
}

TEST(Solve, LinearSolversAgree) {
  const Scene scene = sceneOf({"ds-none", "pinhole-equi"}, 20);
  Problem problem = noisyProblem(scene, kNoise_px, 5);
  Random random(1);
  disturbStart(problem, random);
  SolveOptions options;
  options.linear_solver = LinearSolver::kSchur;
  const Solution schur = solve(problem, options);
  options.linear_solver = LinearSolver::kSparse;
  const Solution sparse = solve(problem, options);
  EXPECT_LT(errorVector(sparse.rig, schur.rig).cwiseAbs().maxCoeff(), 1e-6);
}

TEST(Solve, HoldsWhatIsFixed) {
  const Scene scene = sceneOf({"ds-none", "pinhole-equi", "eucm-none"}, 20);
  Problem problem = noisyProblem(scene, kNoise_px, 5);
  SolveOptions options;
  options.fixed_cameras = {1};
  Solution solution = solve(problem, options);
  EXPECT_EQ(parametersOf(solution.rig, 1), parametersOf(scene.rig, 1));
  EXPECT_NE(parametersOf(solution.rig, 2), parametersOf(scene.rig, 2));
  EXPECT_EQ(solution.rig.cameras[1].T_cam_rig.matrix(), scene.rig.cameras[1].T_cam_rig.matrix());
  EXPECT_EQ(solution.covariance.middleRows(intrinsicsRow(scene.rig, 1), 8).norm(), 0.0);
  EXPECT_EQ(solution.covariance.middleRows(baselineRow(1), 6).norm(), 0.0);
  EXPECT_GT(solution.covariance.middleRows(baselineRow(2), 6).norm(), 0.0);

  options = {};
  options.fix_intrinsics = true;
  options.fix_extrinsics = true;
  solution = solve(problem, options);
  EXPECT_EQ(errorVector(solution.rig, scene.rig).norm(), 0.0);
  EXPECT_NEAR(solution.sigma_px, kNoise_px, 0.1 * kNoise_px);
}

TEST(Solve, FindsTheBoardsWarp) {
  const Scene scene = sceneOf({"ds-none"}, 30);
  const Eigen::Vector2d warp_m(0.002, -0.001);
  Problem problem = exactProblem(scene);
  const std::vector<Eigen::Vector3d> bent = warpedPoints(scene.target_points, warp_m);
  for (std::size_t k = 0; k < problem.views.size(); ++k) {
    for (observation::Corner& corner : problem.views[k].cameras[0].corners) {
      corner.px = *camera::project(scene.rig.cameras[0].camera.model,
                                   scene.T_rig_target[k] * bent[static_cast<std::size_t>(corner.corner_id)]);
    }
  }
  test_support::addNoise(problem.views, kNoise_px, 5);
  SolveOptions options;
  options.estimate_board_warp = true;
  const Solution solution = solve(problem, options);
  const Eigen::Vector2d sigma_m = solution.covariance.diagonal().tail<2>().cwiseSqrt();
  EXPECT_LT(sigma_m.maxCoeff(), 0.1 * warp_m.norm());
  EXPECT_LT((solution.board_warp_m - warp_m).cwiseQuotient(sigma_m).cwiseAbs().maxCoeff(), kMaxNormalisedError);
  EXPECT_LT(normalisedErrors(solution, scene.rig).abs().maxCoeff(), kMaxNormalisedError);
}

TEST(Solve, FindsHowThePupilMoves) {
  const Eigen::Vector2d pupil_m(0.02, -0.004);
  Random random(7);
  Rig rig = rowOfCameras({"ds-none"}, random);
  rig.cameras[0].camera.pupil.coefficients_m = pupil_m;
  SceneOptions scene_options;
  scene_options.num_views = 30;
  const Scene scene = test_support::simulateScene(rig, scene_options);
  Problem problem = noisyProblem(scene, kNoise_px, 5);
  problem.rig.cameras[0].camera.pupil = {};

  const Solution central = solve(problem, {});
  EXPECT_GT(central.sigma_px, 2.0 * kNoise_px);  // no central model explains it
  EXPECT_TRUE(central.rig.cameras[0].camera.pupil.isZero());

  SolveOptions options;
  options.estimate_pupil_shift = true;
  const Solution solution = solve(problem, options);
  const Eigen::Vector2d sigma_m = solution.covariance.diagonal().tail<2>().cwiseSqrt();
  const Eigen::Vector2d error_m = solution.rig.cameras[0].camera.pupil.coefficients_m - pupil_m;
  EXPECT_LT(sigma_m.maxCoeff(), 0.1 * pupil_m.norm());
  EXPECT_LT(error_m.cwiseQuotient(sigma_m).cwiseAbs().maxCoeff(), kMaxNormalisedError);
  EXPECT_LT(normalisedErrors(solution, scene.rig).abs().maxCoeff(), kMaxNormalisedError);
  EXPECT_NEAR(solution.sigma_px, kNoise_px, 0.1 * kNoise_px);
}

TEST(Solve, HoldsThePupilWithTheIntrinsics) {
  Problem problem = noisyProblem(sceneOf({"ds-none"}, 10), kNoise_px, 5);
  problem.rig.cameras[0].camera.pupil.coefficients_m = {0.001, 0.0};
  SolveOptions options;
  options.fix_intrinsics = true;
  options.estimate_pupil_shift = true;
  const Solution solution = solve(problem, options);
  EXPECT_EQ(solution.rig.cameras[0].camera.pupil.coefficients_m, Eigen::Vector2d(0.001, 0.0));
  EXPECT_EQ(solution.covariance.bottomRightCorner(2, 2).norm(), 0.0);
}

}  // namespace
}  // namespace tartan_calib::calibration
