#include "tartan_calib/report/uncertainty.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>

#include "solved_scene.h"
#include "tartan_calib/calibration/compare.h"
#include "tartan_calib/calibration/intrinsics_uncertainty.h"
#include "tartan_calib/report/cross_validation.h"

namespace tartan_calib::report {
namespace {

constexpr double kNoise_px = 0.2;
constexpr int kTrials = 30;

/// 30 trials know a stdev to 13 %, and the worse of two directions is the larger for it.
constexpr double kRatioTolerance = 0.4;

test_support::Scene noisyScene(unsigned seed) {
  test_support::SceneOptions options;
  options.num_views = 20;
  options.max_polar_angle_rad = 1.4;
  test_support::Scene scene = test_support::simulateScene(fisheye(), options);
  test_support::addNoise(scene.views, kNoise_px, seed);
  return scene;
}

std::vector<Eigen::Vector2d> pixelsOf(const test_support::Scene& scene) {
  std::vector<Eigen::Vector2d> pixels;
  for (const observation::CameraView& image : test_support::viewsOf(scene.views, 0)) {
    for (std::size_t i = 0; i < image.corners.size(); i += 4) {
      pixels.push_back(image.corners[i].px);
    }
  }
  return pixels;
}

/// Calls `visit(model)` for calibrations of the same views with other noise.
template <class Visit>
void forEachTrial(const Visit& visit) {
  for (unsigned seed = 100; seed < 100 + kTrials; ++seed) {
    visit(solved(noisyScene(seed)).solution.rig.cameras[0].camera.model);
  }
}

TEST(UncertaintyTest, PredictsTheScatterOfCalibrationsWithOtherNoise) {
  const std::vector<Eigen::Vector2d> samples_px = {
      {320.0, 240.0}, {420.0, 240.0}, {320.0, 100.0}, {560.0, 300.0}, {90.0, 380.0}};
  const test_support::Scene first = noisyScene(1);
  const std::vector<Eigen::Vector2d> aligned_px = pixelsOf(first);
  const auto stdevs_px = projectionStdevs(solved(first).solution, 0, aligned_px, samples_px);

  std::vector<Eigen::Matrix2d> scatter(samples_px.size(), Eigen::Matrix2d::Zero());
  const camera::CameraModel truth = fisheye().model;
  forEachTrial([&](const camera::CameraModel& model) {
    const auto aligned = calibration::compareProjections(truth, model, aligned_px);
    for (std::size_t i = 0; i < samples_px.size(); ++i) {
      const Eigen::Vector2d px = *camera::project(model, aligned.T_b_a * *camera::unproject(truth, samples_px[i]));
      scatter[i] += (px - samples_px[i]) * (px - samples_px[i]).transpose() / kTrials;
    }
  });
  for (std::size_t i = 0; i < samples_px.size(); ++i) {
    const double measured_px = std::sqrt(Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(scatter[i]).eigenvalues()(1));
    ASSERT_TRUE(stdevs_px[i]);
    EXPECT_NEAR(measured_px / *stdevs_px[i], 1.0, kRatioTolerance) << samples_px[i].transpose();
  }
}

TEST(UncertaintyTest, OfTheFocalLengthIsTheScatterOfTheScaleOnTheAxis) {
  const auto scale = [](const camera::CameraModel& model) {
    constexpr double kAngle_rad = 1e-3;
    return (camera::project(model, {std::sin(kAngle_rad), 0.0, std::cos(kAngle_rad)})->x() -
            camera::project(model, {0.0, 0.0, 1.0})->x()) /
           kAngle_rad;
  };
  double variance = 0.0;
  forEachTrial([&](const camera::CameraModel& model) {
    const double ratio = scale(model) / scale(fisheye().model) - 1.0;
    variance += ratio * ratio / kTrials;
  });
  const double predicted = calibration::focalStdevRatio(solved(noisyScene(1)).solution, 0);
  EXPECT_NEAR(std::sqrt(variance) / predicted, 1.0, kRatioTolerance);
}

TEST(UncertaintyTest, IsEmptyWhereThereIsNoRay) {
  const test_support::Scene scene = noisyScene(1);
  EXPECT_FALSE(projectionStdevs(solved(scene).solution, 0, pixelsOf(scene), {{4000.0, 3000.0}}).front());
}

TEST(CrossValidationTest, HalvesWithNoiseAloneDifferAsTheirUncertaintiesSay) {
  double squares = 0.0;
  for (unsigned seed = 1; seed <= kTrials; ++seed) {
    const CameraAnalysis camera = analysed(solved(noisyScene(seed))).cameras.front();
    ASSERT_TRUE(camera.median_difference_px);
    squares += std::pow(*camera.median_difference_px / camera.median_expected_difference_px, 2) / kTrials;
  }
  // The length of a difference in two directions against the stdev in the worse one.
  EXPECT_GT(std::sqrt(squares), 0.7);
  EXPECT_LT(std::sqrt(squares), 1.6);
}

TEST(CrossValidationTest, IsLeftOutWhereTheIntrinsicsAreFixedOrViewsAreFew) {
  pipeline::CalibrateOptions fixed;
  fixed.solve.fix_intrinsics = true;
  const pipeline::CalibrationResult result = solved(noisyScene(1));
  EXPECT_TRUE(solveHalves(result, {}));
  EXPECT_FALSE(solveHalves(result, fixed));
  test_support::Scene few = noisyScene(1);
  few.views.resize(5);
  few.T_rig_target.resize(5);
  EXPECT_FALSE(solveHalves(solved(few), {}));
}

TEST(CrossValidationTest, StopsWhenCancelled) {
  EXPECT_THROW(solveHalves(solved(noisyScene(1)), {}, {{}, [] { return true; }}), pipeline::Cancelled);
}

TEST(CrossValidationTest, TellsHowMuchOfBothHalvesIsDone) {
  std::vector<std::size_t> percents;
  const auto tell = [&percents](std::size_t done, std::size_t total) {
    EXPECT_EQ(total, 100U);
    percents.push_back(done);
  };
  ASSERT_TRUE(solveHalves(solved(noisyScene(1)), {}, {tell, {}}));
  EXPECT_TRUE(std::is_sorted(percents.begin(), percents.end()));
  EXPECT_GT(percents.front(), 0U);
  EXPECT_LT(percents.front(), 50U);
  EXPECT_GT(percents.back(), 50U);
  EXPECT_LE(percents.back(), 100U);
}

}  // namespace
}  // namespace tartan_calib::report
