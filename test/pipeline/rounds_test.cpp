#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <atomic>
#include <functional>
#include <opencv2/imgproc.hpp>
#include <set>

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

std::int64_t stampOf(std::size_t image) { return kWideFirst_ns + static_cast<std::int64_t>(image) * kWidePeriod_ns; }

bool takesPart(const CalibrationResult& result, std::size_t image) {
  return std::any_of(result.solution.views.begin(), result.solution.views.end(),
                     [image](const observation::View& view) { return view.stamp_ns == stampOf(image); });
}

std::vector<observation::Corner> cornersIn(const CalibrationResult& result, std::size_t image) {
  const std::vector<CameraCorners> observed = observedCorners(result);
  for (const observation::CameraView& view : observed.front().images) {
    if (view.stamp_ns == stampOf(image)) {
      return view.corners;
    }
  }
  return {};
}

/// Corners that a result has and another has not, of images that took part in both.
int gained(const CalibrationResult& before, const CalibrationResult& after) {
  int count = 0;
  for (std::size_t image = 0; image < kNumWideImages; ++image) {
    if (!takesPart(before, image) || !takesPart(after, image)) {
      continue;
    }
    std::set<int> known;
    for (const observation::Corner& corner : cornersIn(before, image)) {
      known.insert(corner.corner_id);
    }
    for (const observation::Corner& corner : cornersIn(after, image)) {
      count += known.count(corner.corner_id) == 0 ? 1 : 0;
    }
  }
  return count;
}

/// Corners that are not where they really are.
int countWrong(const CalibrationResult& result) {
  constexpr double kWrong_px = 0.5;
  int count = 0;
  for (std::size_t image = 0; image < kNumWideImages; ++image) {
    const std::vector<simulation::TrueCorner> truth = wideTruth(image);
    for (const observation::Corner& corner : cornersIn(result, image)) {
      const auto match =
          std::find_if(truth.begin(), truth.end(), [&](const auto& t) { return t.corner_id == corner.corner_id; });
      count += match == truth.end() || (match->px - corner.px).norm() > kWrong_px ? 1 : 0;
    }
  }
  return count;
}

TEST(RoundsTest, FindCornersThatDetectionMissed) {
  const CalibrationResult before = run(0);
  const CalibrationResult after = run(5);
  EXPECT_TRUE(before.rounds.empty());
  ASSERT_FALSE(after.rounds.empty());
  EXPECT_GT(gained(before, after), 10);
  EXPECT_EQ(countWrong(after), 0);
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

/// The recording whose images change when they are read again.
CameraStream streamThatChanges(const std::function<cv::Mat(std::size_t index, const cv::Mat& image)>& change) {
  CameraStream stream = wideStream();
  stream.open = [change, open = stream.open, num_passes = 0]() mutable -> ImageSource {
    return [change, is_again = num_passes++ > 0, source = open(), next = std::size_t{0}]() mutable {
      std::optional<StampedImage> image = source();
      if (image && is_again) {
        image->load = [change, index = next++, load = image->load] { return change(index, load()); };
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
    const auto hide = [](std::size_t index, const cv::Mat& image) {
      return index == kLostImage ? cv::Mat(image.size(), CV_8UC1, cv::Scalar(128)) : image;
    };
    const CalibrationResult result = calibrate({streamThatChanges(hide)}, target::AprilGrid(), options);
    return observedCorners(result).front().images[kLostImage].corners.size();
  };
  const std::size_t num_before = num_corners();
  EXPECT_GT(num_before, 100U);
  options.max_rounds = 1;
  EXPECT_EQ(num_corners(), num_before);
}

TEST(RoundsTest, ImagesThatHaveBecomeUnreadableKeepTheirCorners) {
  CalibrateOptions options;
  options.models = {"ds-none"};
  options.max_rounds = 1;
  options.min_tags = kWideMinTags;
  const auto fail = [](std::size_t /*index*/, const cv::Mat& /*image*/) -> cv::Mat { throw InputError("no such disk"); };
  const CalibrationResult result = calibrate({streamThatChanges(fail)}, target::AprilGrid(), options);
  ASSERT_EQ(result.rounds.size(), 1U);
  EXPECT_EQ(result.rounds[0].lost, 0);
  EXPECT_EQ(result.rounds[0].gained, 0);
}

TEST(RoundsTest, ARoundThatLeadsToNoCalibrationIsGivenUp) {
  CalibrateOptions options;
  options.models = {"ds-none"};
  options.max_rounds = 3;
  options.min_tags = kWideMinTags;
  const CalibrationResult before = run(0);
  const auto cut = [](std::size_t /*index*/, const cv::Mat& image) { return image.colRange(0, image.cols / 2).clone(); };
  const CalibrationResult result = calibrate({streamThatChanges(cut)}, target::AprilGrid(), options);
  EXPECT_TRUE(result.rounds.empty());
  EXPECT_EQ(camera::parameters(result.solution.rig.cameras[0].camera.model),
            camera::parameters(before.solution.rig.cameras[0].camera.model));
  EXPECT_EQ(result.solution.counts[0].used, before.solution.counts[0].used);
  EXPECT_EQ(result.cameras[0].num_images_detected, before.cameras[0].num_images_detected);
  EXPECT_EQ(result.graph.shared_views, before.graph.shared_views);
  EXPECT_TRUE(std::any_of(result.warnings.begin(), result.warnings.end(), [](const std::string& warning) {
    return warning.find("round 1 did not end with a calibration, that of the round before is kept") == 0;
  }));
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

CameraStream countingLoads(CameraStream stream, std::atomic<std::size_t>& num_loads) {
  stream.open = [&num_loads, open = stream.open] {
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
  return stream;
}

TEST(RoundsTest, LeaveImagesAloneWhosePredictionsHaveNotMoved) {
  std::atomic<std::size_t> num_loads{0};
  CalibrateOptions options;
  options.models = {"ds-none"};
  options.min_tags = kWideMinTags;
  const CalibrationResult result = calibrate({countingLoads(wideStream(), num_loads)}, target::AprilGrid(), options);
  ASSERT_GE(result.rounds.size(), 2U);
  // Detection and the first round look at every image, later rounds at next to none.
  EXPECT_GE(num_loads, 2 * kNumWideImages);
  EXPECT_LE(num_loads, 2 * kNumWideImages + 3);
}

/// The recording, which shows only the middle of the images until the second pass.
CameraStream streamThatOpensUp(int radius_px) {
  CameraStream stream = wideStream();
  stream.open = [radius_px, open = stream.open, num_passes = 0]() mutable -> ImageSource {
    return [radius_px, is_first = num_passes++ == 0, source = open()]() -> std::optional<StampedImage> {
      std::optional<StampedImage> image = source();
      if (image && is_first) {
        image->load = [radius_px, load = image->load] {
          const cv::Mat whole = load();
          cv::Mat inside(whole.size(), CV_8UC1, cv::Scalar(0));
          cv::circle(inside, {whole.cols / 2, whole.rows / 2}, radius_px, cv::Scalar(255), cv::FILLED);
          cv::Mat middle(whole.size(), CV_8UC1, cv::Scalar(0));
          whole.copyTo(middle, inside);
          return middle;
        };
      }
      return image;
    };
  };
  return stream;
}

TEST(RoundsTest, LookAgainWhereTheModelHasMovedThePredictions) {
  std::atomic<std::size_t> num_loads{0};
  CalibrateOptions options;
  options.models = {"ds-none"};
  options.max_rounds = 2;
  constexpr int kRadius_px = 100;
  const CalibrationResult result =
      calibrate({countingLoads(streamThatOpensUp(kRadius_px), num_loads)}, target::AprilGrid(), options);
  ASSERT_EQ(result.rounds.size(), 2U);
  EXPECT_GT(result.rounds[0].model_change_px, 1.0) << "the middle of the image must say little about its rim";
  EXPECT_GT(num_loads, 2 * kNumWideImages + 3);
  EXPECT_GT(result.rounds[1].gained, 20);
  EXPECT_EQ(countWrong(result), 0);
}

TEST(RoundsTest, FilterByQuadrilateralsFindsFewerCornersAndNoneThatIsWrong) {
  CalibrateOptions options;
  options.models = {"ds-none"};
  options.max_rounds = 1;
  const CalibrationResult image = calibrate({wideStream()}, target::AprilGrid(), options);
  options.recovery.filter = detection::CornerFilter::kQuads;
  const CalibrationResult quads = calibrate({wideStream()}, target::AprilGrid(), options);
  options.max_rounds = 0;
  const CalibrationResult before = calibrate({wideStream()}, target::AprilGrid(), options);
  EXPECT_GT(gained(before, quads), 5);
  EXPECT_LT(gained(before, quads), gained(before, image));
  EXPECT_EQ(countWrong(quads), 0);
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
