#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <atomic>

#include "tartan_calib/calibration/compare.h"
#include "wide_recording.h"

namespace tartan_calib::pipeline {
namespace {

CalibrationResult run(int max_rounds, int num_threads = 0) {
  CalibrateOptions options;
  options.models = {"ds-none"};
  options.max_rounds = max_rounds;
  options.num_threads = num_threads;
  options.min_tags = kWideMinTags;
  return calibrate({wideStream()}, target::AprilGrid(), options);
}

bool takesPart(const CalibrationResult& result, std::size_t image) {
  for (const observation::View& view : result.solution.views) {
    if (view.stamp_ns == kWideFirst_ns + static_cast<std::int64_t>(image) * kWidePeriod_ns) {
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
    return calibration::compareProjections(wideCamera().model, result.solution.rig.cameras[0].camera.model,
                                           calibration::imageGrid(640, 640, 20.0))
        .rms_px;
  };
  EXPECT_LT(error_px(after), 0.02);
}

TEST(RoundsTest, ResidualsAreWhatTheCovariancesOfTheCornersSay) {
  const calibration::Solution solution = run(5).solution;
  const std::vector<Eigen::Vector3d> points = target::cornerPoints(target::AprilGrid());
  double squares = 0.0;
  int freedom = -static_cast<int>(camera::parameters(wideCamera().model).size());
  for (std::size_t i = 0; i < solution.views.size(); ++i) {
    freedom -= 6;
    for (const observation::Corner& corner : solution.views[i].cameras.front().corners) {
      const auto r_px = calibration::residual(solution.rig, solution.T_rig_target[i],
                                              points[static_cast<std::size_t>(corner.corner_id)], 0, corner.px);
      if (corner.used && r_px) {
        squares += r_px->dot(corner.cov_px2.inverse() * *r_px);
        freedom += 2;
      }
    }
  }
  EXPECT_NEAR(std::sqrt(squares / freedom), 1.0, 0.1);
  EXPECT_NEAR(solution.sigma_whitened, 1.0, 0.1);
}

TEST(RoundsTest, AnImageWithTooFewTagsForRoundZeroTakesPartAfterwards) {
  EXPECT_FALSE(takesPart(run(0), kLeavingImage));
  EXPECT_TRUE(takesPart(run(1), kLeavingImage));
}

/// The recording, of which one image shows nothing from the second pass on.
CameraStream streamThatLoses(std::size_t image_index) {
  CameraStream stream = wideStream();
  stream.open = [image_index, open = stream.open, num_passes = 0]() mutable -> ImageSource {
    return [image_index, is_lost = num_passes++ > 0, source = open(), next = std::size_t{0}]() mutable {
      std::optional<StampedImage> image = source();
      if (is_lost && next++ == image_index) {
        image->load = [] { return cv::Mat(640, 640, CV_8UC1, cv::Scalar(128)); };
      }
      return image;
    };
  };
  return stream;
}

TEST(RoundsTest, CornersThatAreNotFoundAgainAreKeptWhereTheyFit) {
  constexpr std::size_t kLostImage = 3;
  CalibrateOptions options;
  options.models = {"ds-none"};
  options.max_rounds = 0;
  options.min_tags = kWideMinTags;
  const auto num_corners = [&] {
    const CalibrationResult result = calibrate({streamThatLoses(kLostImage)}, target::AprilGrid(), options);
    return observedCorners(result).front().images[kLostImage].corners.size();
  };
  const std::size_t num_before = num_corners();
  EXPECT_GT(num_before, 100U);
  options.max_rounds = 1;
  EXPECT_EQ(num_corners(), num_before);
}

TEST(RoundsTest, CornersKnowTheRoundThatSawThemFirst) {
  const auto count = [](const CalibrationResult& result, int round) {
    int corners = 0;
    const std::vector<CameraCorners> observed = observedCorners(result);
    for (const observation::CameraView& image : observed.front().images) {
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

TEST(RoundsTest, LeaveImagesAloneWhosePredictionsHaveNotMoved) {
  std::atomic<std::size_t> num_loads{0};
  CameraStream stream = wideStream();
  const auto open = stream.open;
  stream.open = [&num_loads, open] {
    return [&num_loads, next = open()]() -> std::optional<StampedImage> {
      auto image = next();
      if (image) {
        image->load = [&num_loads, load = image->load] {
          ++num_loads;
          return load();
        };
      }
      return image;
    };
  };
  CalibrateOptions options;
  options.models = {"ds-none"};
  options.min_tags = kWideMinTags;
  const CalibrationResult result = calibrate({stream}, target::AprilGrid(), options);
  ASSERT_GE(result.rounds.size(), 2U);
  // Detection and the first round look at every image, later rounds at next to none.
  EXPECT_GE(num_loads, 2 * kNumWideImages);
  EXPECT_LE(num_loads, 2 * kNumWideImages + 3);
}

TEST(RoundsTest, FilterByQuadrilateralsFindsFewerCornersAndNoneThatIsWrong) {
  CalibrateOptions options;
  options.models = {"ds-none"};
  options.max_rounds = 1;
  const CalibrationResult image = calibrate({wideStream()}, target::AprilGrid(), options);
  options.recovery.filter = detection::CornerFilter::kQuads;
  const CalibrationResult quads = calibrate({wideStream()}, target::AprilGrid(), options);
  const CalibrationResult before = run(0);
  EXPECT_GE(quads.cameras[0].statistics.num_corners, before.cameras[0].statistics.num_corners);
  EXPECT_LT(quads.cameras[0].statistics.num_corners, image.cameras[0].statistics.num_corners);
  EXPECT_LT(quads.cameras[0].statistics.rms_px, 0.1);
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
