#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <vector>

#include "support/board_scene.h"
#include "tartan_calib/calibration/compare.h"
#include "tartan_calib/pipeline/calibrate.h"

namespace tartan_calib::pipeline {
namespace {

using test_support::BoardPose;
using test_support::BoardScene;
using test_support::kDegree;

constexpr std::int64_t kPeriod_ns = 100'000'000;
constexpr std::int64_t kFirst_ns = 1'000'000'000;
constexpr std::size_t kNumImages = 14;
/// The board leaves the image here: too few tags for taking part in round 0.
constexpr std::size_t kLeavingImage = 6;
constexpr int kMinTags = 30;

camera::Camera truth() {
  Eigen::VectorXd parameters(6);
  parameters << -0.2, 0.59, 156.0, 156.0, 321.3, 317.2;
  return {camera::withParameters(camera::modelByName("ds-none"), parameters), 640, 640};
}

BoardPose boardPose(std::size_t i) {
  if (i == kLeavingImage) {
    return {0.35, 84.0 * kDegree, 0.4, 0.0, 0.0, 10.0 * kDegree};
  }
  const double azimuth = 2.39996 * static_cast<double>(i);  // the golden angle spreads them
  const double polar = (10.0 + 5.0 * static_cast<double>(i)) * kDegree;
  return {0.45 + 0.01 * static_cast<double>(i), polar,        azimuth, 0.4 * std::sin(azimuth),
          0.35 * std::cos(2.0 * azimuth),       0.5 * azimuth};
}

std::vector<StampedImage> recording() {
  std::vector<StampedImage> images;
  for (std::size_t i = 0; i < kNumImages; ++i) {
    BoardScene scene(truth());
    scene.add(target::AprilGrid(), boardPose(i));
    images.push_back({kFirst_ns + static_cast<std::int64_t>(i) * kPeriod_ns,
                      [image = scene.expose(0.6, 2.0, i + 1)] { return image.clone(); }});
  }
  return images;
}

CameraStream streamOf(const std::vector<StampedImage>& images) {
  CameraStream stream{"/cam0/image_raw", images.size(), {}};
  stream.open = [images] {
    auto next = std::make_shared<std::size_t>(0);
    return [images, next]() -> std::optional<StampedImage> {
      return *next < images.size() ? std::optional<StampedImage>(images[(*next)++]) : std::nullopt;
    };
  };
  return stream;
}

CalibrationResult run(int max_rounds, int num_threads = 0) {
  static const std::vector<StampedImage> images = recording();
  CalibrateOptions options;
  options.models = {"ds-none"};
  options.max_rounds = max_rounds;
  options.num_threads = num_threads;
  options.min_tags = kMinTags;
  return calibrate({streamOf(images)}, target::AprilGrid(), options);
}

bool takesPart(const CalibrationResult& result, std::size_t image) {
  for (const observation::View& view : result.solution.views) {
    if (view.stamp_ns == kFirst_ns + static_cast<std::int64_t>(image) * kPeriod_ns) {
      return true;
    }
  }
  return false;
}

TEST(RoundsTest, FindCornersThatDetectionMissed) {
  const CalibrationResult before = run(0);
  const CalibrationResult after = run(5);
  EXPECT_TRUE(before.rounds.empty());
  ASSERT_FALSE(after.rounds.empty());
  EXPECT_GT(after.cameras[0].statistics.num_corners, before.cameras[0].statistics.num_corners);
  EXPECT_LT(after.cameras[0].statistics.rms_px, 0.1);
  const auto error_px = [](const CalibrationResult& result) {
    return calibration::compareProjections(truth().model, result.solution.rig.cameras[0].camera.model,
                                           calibration::imageGrid(640, 640, 20.0))
        .rms_px;
  };
  EXPECT_LT(error_px(after), 0.02);
}

TEST(RoundsTest, AnImageWithTooFewTagsForRoundZeroTakesPartAfterwards) {
  EXPECT_FALSE(takesPart(run(0), kLeavingImage));
  EXPECT_TRUE(takesPart(run(1), kLeavingImage));
}

TEST(RoundsTest, CornersKnowTheRoundThatSawThemFirst) {
  const auto count = [](const CalibrationResult& result, int round) {
    int corners = 0;
    for (const observation::CameraView& image : observedCorners(result).front().images) {
      corners += static_cast<int>(std::count_if(image.corners.begin(), image.corners.end(),
                                                [round](const auto& corner) { return corner.round == round; }));
    }
    return corners;
  };
  const CalibrationResult before = run(0);
  const CalibrationResult after = run(1);
  EXPECT_GT(count(after, 1), 0);
  EXPECT_EQ(count(after, 1), after.rounds[0].gained);
  EXPECT_EQ(count(after, 0), count(before, 0) - after.rounds[0].lost);
}

TEST(RoundsTest, StopOnceNothingImproves) {
  const CalibrationResult result = run(20);
  EXPECT_LT(result.rounds.size(), 6U);
  const RoundSummary& last = result.rounds.back();
  EXPECT_LT(last.gained, 0.01 * last.corners);
  EXPECT_LT(last.model_change_px, 0.02);
  EXPECT_EQ(last.round, static_cast<int>(result.rounds.size()));
}

TEST(RoundsTest, TheNumberOfThreadsChangesNothing) {
  const CalibrationResult one = run(2, 1);
  const CalibrationResult three = run(2, 3);
  EXPECT_EQ(camera::parameters(one.solution.rig.cameras[0].camera.model),
            camera::parameters(three.solution.rig.cameras[0].camera.model));
  EXPECT_EQ(one.solution.covariance, three.solution.covariance);
}

}  // namespace
}  // namespace tartan_calib::pipeline
