#include "tartan_calib/report/verdict.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "moving_scene.h"
#include "tartan_calib/pipeline/calibrate.h"

namespace tartan_calib::report {
namespace {

constexpr double kNoise_px = 0.05;

test_support::Scene sceneOf(const camera::Camera& camera, const test_support::SceneOptions& options = {}) {
  test_support::Scene scene = test_support::simulateScene(camera, options);
  test_support::addNoise(scene.views, kNoise_px, 1);
  return scene;
}

camera::Camera pinhole() {
  return {camera::startModel(camera::modelByName("pinhole-none"), 500.0, {319.5, 239.5}), 640, 480};
}

Verdict judged(const pipeline::CalibrationResult& result) { return judge(result, analysed(result)); }

Verdict judged(const test_support::Scene& scene) { return judged(solved(scene)); }

/// The first reason with these words; fails the test where there is none.
Reason reasonWith(const Verdict& verdict, const std::string& words) {
  std::string all;
  for (const Reason& reason : verdict.reasons) {
    if (reason.text.find(words) != std::string::npos) {
      return reason;
    }
    all += "\n  " + reason.text;
  }
  ADD_FAILURE() << "no reason with '" << words << "' among:" << all;
  return {};
}

std::string textOf(const Verdict& verdict) {
  std::string text;
  for (const Reason& reason : verdict.reasons) {
    text += reason.text + "\n";
  }
  return text;
}

TEST(VerdictTest, ManyVariedViewsOverTheWholeImageAreGood) {
  for (const camera::Camera& camera : {fisheye(), pinhole()}) {
    test_support::SceneOptions options;
    options.num_views = 60;
    const Verdict verdict = judged(sceneOf(camera, options));
    EXPECT_EQ(gradeName(verdict.grade), "good") << textOf(verdict);
    EXPECT_EQ(verdict.facts.size(), 1U);
  }
  const Verdict rig = judged(movingScene(0.0));
  EXPECT_EQ(gradeName(rig.grade), "good") << textOf(rig);
}

TEST(VerdictTest, SmallUncertaintyIsNotSaidToBeNone) {
  const pipeline::CalibrationResult result = solved(sceneOf(pinhole()));
  Analysis analysis = analysed(result);
  for (const auto& [stdev_px, words] :
       {std::pair(0.0004, "certain to better than 0.001 px (median)"), std::pair(0.0006, "certain to 0.001 px (median)")}) {
    analysis.cameras[0].median_stdev_px = stdev_px;
    const std::string fact = judge(result, analysis).facts.front();
    EXPECT_NE(fact.find(words), std::string::npos) << fact;
  }
}

TEST(VerdictTest, AnEdgeWithoutCornersIsExtrapolated) {
  test_support::SceneOptions options;
  options.max_polar_angle_rad = 60.0 * M_PI / 180.0;
  const Verdict verdict = judged(sceneOf(fisheye(), options));
  reasonWith(verdict, "cam0: no corner beyond 60 degrees");
  EXPECT_NE(verdict.grade, Grade::kGood);
}

TEST(VerdictTest, AnEdgeWhoseCornersWereRejectedAsksForARicherModel) {
  pipeline::CalibrationResult result = solved(sceneOf(fisheye()));
  Analysis analysis = analysed(result);
  const double end_rad = result.cameras[0].statistics.max_polar_angle_rad;
  analysis.cameras[0].extrapolated_ratio = 0.1;
  const auto judged_with = [&](int num_beyond, int num_rejected) {
    result.solution.counts[0].outliers = num_rejected;
    for (int i = 0; i < num_beyond; ++i) {
      FoundCorner& corner = analysis.cameras[0].corners.found[static_cast<std::size_t>(i)];
      corner.used = false;
      corner.polar_rad = i % 2 == 0 ? std::make_optional(end_rad + 0.01) : std::nullopt;
    }
    return judge(result, analysis);
  };
  reasonWith(judged_with(19, 19), "cam0: no corner beyond");
  reasonWith(judged_with(20, 101), "cam0: no corner beyond");  // of many that were rejected all over the image
  const Verdict verdict = judged_with(20, 100);
  reasonWith(verdict, "cam0: all 20 corners beyond");
  EXPECT_EQ(textOf(verdict).find("hold the board there"), std::string::npos);
}

TEST(VerdictTest, ARegionWithoutCornersIsNamed) {
  test_support::Scene scene = sceneOf(pinhole());
  for (observation::View& view : scene.views) {
    auto& corners = view.cameras.front().corners;
    corners.erase(std::remove_if(corners.begin(), corners.end(),
                                 [](const auto& corner) { return corner.px.x() < 220.0 && corner.px.y() > 310.0; }),
                  corners.end());
  }
  EXPECT_NE(reasonWith(judged(scene), "no corner in these parts").text.find("lower left"), std::string::npos);
}

TEST(VerdictTest, ABoardThatAlwaysFacesTheCameraLeavesTheFocalLengthOpen) {
  test_support::SceneOptions options;
  options.facing = test_support::Facing::kImagePlane;
  options.max_tilt_rad = 0.03;
  options.num_views = 15;
  reasonWith(judged(sceneOf(pinhole(), options)), "views too similar: focal length uncertain to");
}

TEST(VerdictTest, CamerasThatAreNotInSyncAreNamedWithTheirDelay) {
  const Verdict verdict = judged(movingScene(4.0));
  reasonWith(verdict, "cam1: stereo pairs 4.0 ms apart (their stamps: 0.0 ms)");
  EXPECT_EQ(verdict.grade, Grade::kRepeat);
}

TEST(VerdictTest, ALensThatTheModelCannotFollowAsksForARicherOne) {
  Eigen::VectorXd parameters(8);
  parameters << 150.0, 150.0, 319.0, 240.5, -0.08, 0.05, -0.02, 0.003;
  const camera::Camera lens{camera::withParameters(camera::modelByName("pinhole-equi"), parameters), 640, 480};
  test_support::SceneOptions options;
  options.max_polar_angle_rad = 1.45;
  const test_support::Scene scene = sceneOf(lens, options);
  pipeline::CameraCorners corners;
  corners.topic = "/cam0/image_raw";
  corners.width = lens.width;
  corners.height = lens.height;
  corners.images = test_support::viewsOf(scene.views, 0);
  corners.num_images = scene.views.size();
  pipeline::CalibrateOptions calibrate;
  for (const auto& [model, richer] : {std::pair("pinhole-fov", "pinhole-equi or ds-none"),
                                      std::pair("eucm-none", "ds-none, pinhole-equi or omni-radtan")}) {
    calibrate.models = {model};
    const Verdict verdict = judged(pipeline::calibrateCorners({corners}, target::AprilGrid(), calibrate));
    reasonWith(verdict, std::string(model) + " is too simple for this lens, try " + richer);
  }
}

TEST(VerdictTest, UncertaintyThatComesFromTheModelAsksForNoMoreViews) {
  pipeline::CalibrationResult result = solved(sceneOf(pinhole()));
  Analysis analysis = analysed(result);
  const auto says_more_views = [&](double stdev_px, double bias_px) {
    analysis.cameras[0].median_stdev_px = stdev_px;
    analysis.cameras[0].radial_biases = {{0.5, 0.7, 20, bias_px, 0.01}};
    result.cameras[0].statistics.rms_px = 1.0;
    return textOf(judge(result, analysis)).find("too little data") != std::string::npos;
  };
  EXPECT_TRUE(says_more_views(0.5, 0.0));
  EXPECT_FALSE(says_more_views(0.5, 0.6));
  EXPECT_TRUE(says_more_views(1.5, 0.6));  // larger than the residuals
}

TEST(VerdictTest, HalvesThatDisagreePointToACameraThatChanged) {
  test_support::SceneOptions options;
  test_support::Scene scene = test_support::simulateScene(pinhole(), options);
  for (std::size_t i = 1; i < scene.views.size(); i += 2) {
    for (observation::Corner& corner : scene.views[i].cameras.front().corners) {
      corner.px = Eigen::Vector2d(319.5, 239.5) + 1.004 * (corner.px - Eigen::Vector2d(319.5, 239.5));
    }
  }
  test_support::addNoise(scene.views, kNoise_px, 1);
  reasonWith(judged(scene), "even and odd views give calibrations");
}

TEST(VerdictTest, LargeResidualsSayWhatToLookFor) {
  test_support::Scene scene = test_support::simulateScene(pinhole(), {});
  test_support::addNoise(scene.views, 1.5, 1);
  const Reason reason = reasonWith(judged(scene), "large residuals");
  EXPECT_EQ(reason.grade, Grade::kRepeat);
}

TEST(VerdictTest, ManyRejectedCornersAreCounted) {
  test_support::Scene scene = sceneOf(pinhole());
  test_support::addWrongCorners(scene.views, 0.15, 20.0, 2);
  reasonWith(judged(scene), "% of the corners were rejected");
}

TEST(VerdictTest, FewViewsAreSaid) {
  test_support::SceneOptions options;
  options.num_views = 6;
  reasonWith(judged(sceneOf(fisheye(), options)), "only 6 views");
}

TEST(VerdictTest, ACameraThatSharesFewViewsIsNamed) {
  test_support::Scene scene = movingScene(0.0);
  for (std::size_t i = 3; i < scene.views.size(); ++i) {
    auto& cameras = scene.views[i].cameras;
    cameras.erase(cameras.begin() + (i % 2 == 0 ? 0 : 1));
  }
  reasonWith(judged(scene), "cam1 shares only 3 views");
}

TEST(VerdictTest, ASolveWithoutEndMeansRepeat) {
  pipeline::CalibrationResult result = solved(sceneOf(pinhole()));
  result.solution.status = calibration::SolveStatus::kMaxIterations;
  const Reason reason = reasonWith(judged(result), "the solver did not converge within");
  EXPECT_EQ(reason.grade, Grade::kRepeat);
}

TEST(VerdictTest, WhatTheViewsDoNotDetermineMeansRepeat) {
  pipeline::CalibrationResult result = solved(sceneOf(pinhole()));
  result.solution.undetermined = {"cam0 projection[0]"};
  const Verdict verdict = judged(result);
  EXPECT_EQ(verdict.grade, Grade::kRepeat);
  EXPECT_EQ(verdict.reasons.front().text.find("the views do not determine cam0 projection[0]"), 0U);
}

}  // namespace
}  // namespace tartan_calib::report
