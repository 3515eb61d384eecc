#include "tartan_calib/pipeline/calibrate.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <opencv2/imgproc.hpp>

#include "board_stream.h"
#include "support/expect_message.h"
#include "support/simulated_scene.h"

namespace tartan_calib::pipeline {
namespace {

using test_support::expectMessage;

constexpr double kNoise_px = 0.1;

camera::Camera cameraOf(const std::string& model, const std::vector<double>& parameters) {
  const Eigen::Map<const Eigen::VectorXd> values(parameters.data(), static_cast<Eigen::Index>(parameters.size()));
  return {camera::withParameters(camera::modelByName(model), values), 752, 480};
}

calibration::Rig stereoRig() {
  const camera::Camera left = cameraOf("pinhole-radtan", {458, 457, 367, 248, -0.28, 0.07, 0.0002, 1e-5});
  const camera::Camera right = cameraOf("ds-none", {-0.2, 0.55, 300, 301, 379, 255});
  return {{{left, geometry::Rigid3()},
           {right, geometry::Rigid3(geometry::expRotation({0.01, -0.02, 0.005}), Eigen::Vector3d(-0.11, 0.001, 0.002))}}};
}

/// What the rig's cameras see, as if detected; the second camera is 2 ms late.
std::vector<CameraCorners> cornersOf(const calibration::Rig& rig, int num_views) {
  test_support::SceneOptions options;
  options.num_views = num_views;
  test_support::Scene scene = test_support::simulateScene(rig, options);
  test_support::addNoise(scene.views, kNoise_px, 3);
  std::vector<CameraCorners> cameras(rig.cameras.size());
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    cameras[i].topic = "/cam" + std::to_string(i);
    cameras[i].width = rig.cameras[i].camera.width;
    cameras[i].height = rig.cameras[i].camera.height;
    cameras[i].images = test_support::viewsOf(scene.views, static_cast<int>(i));
    cameras[i].num_images = cameras[i].images.size() + 5;
    for (observation::CameraView& image : cameras[i].images) {
      image.stamp_ns += static_cast<std::int64_t>(i) * 2'000'000;
    }
  }
  return cameras;
}

CalibrateOptions optionsFor(const std::vector<std::string>& models) {
  CalibrateOptions options;
  options.models = models;
  options.num_threads = 1;
  return options;
}

const std::vector<std::string> kStereoModels = {"pinhole-radtan", "ds-none"};

TEST(CalibrateCorners, RecoversARigFromNothing) {
  const calibration::Rig truth = stereoRig();
  const CalibrationResult result = calibrateCorners(cornersOf(truth, 40), target::AprilGrid(), optionsFor(kStereoModels));
  EXPECT_EQ(result.solution.status, calibration::SolveStatus::kConverged);
  for (std::size_t i = 0; i < 2; ++i) {
    const Eigen::VectorXd error =
        camera::parameters(result.solution.rig.cameras[i].camera.model) - camera::parameters(truth.cameras[i].camera.model);
    const int focal = camera::focalIndex(truth.cameras[i].camera.model);
    // Four standard deviations as the solution itself states them.
    const Eigen::VectorXd stdev = result.solution.covariance.diagonal()
                                      .segment(calibration::intrinsicsRow(truth, static_cast<int>(i)), error.size())
                                      .cwiseSqrt();
    EXPECT_LT(std::abs(error(focal)), 4.0 * stdev(focal));
    EXPECT_LT(stdev(focal), 1.0);
    // Noise per axis over both axes.
    EXPECT_NEAR(result.cameras[i].statistics.rms_px, kNoise_px * std::sqrt(2.0), 0.01);
    EXPECT_EQ(result.cameras[i].topic, "/cam" + std::to_string(i));
  }
  EXPECT_LT((result.solution.rig.cameras[1].T_cam_rig.translation - truth.cameras[1].T_cam_rig.translation).norm(), 5e-4);
  EXPECT_GT(result.graph.shared_corners(0, 1), 0);
}

TEST(CalibrateCorners, EveryCornerOfTheInputIsInTheResult) {
  const std::vector<CameraCorners> input = cornersOf(stereoRig(), 30);
  const CalibrationResult result = calibrateCorners(input, target::AprilGrid(), optionsFor(kStereoModels));
  const std::vector<CameraCorners> observed = observedCorners(result);
  ASSERT_EQ(observed.size(), input.size());
  for (std::size_t i = 0; i < input.size(); ++i) {
    EXPECT_EQ(observed[i].topic, input[i].topic);
    EXPECT_EQ(observed[i].width, input[i].width);
    EXPECT_EQ(observed[i].num_images, input[i].num_images);
    ASSERT_EQ(observed[i].images.size(), input[i].images.size());
    for (std::size_t k = 0; k < input[i].images.size(); ++k) {
      EXPECT_EQ(observed[i].images[k].stamp_ns, input[i].images[k].stamp_ns);
      EXPECT_EQ(observed[i].images[k].corners.size(), input[i].images[k].corners.size());
    }
  }
}

TEST(CalibrateCorners, FromItsOwnObservedCornersTheResultIsTheSame) {
  CalibrateOptions options = optionsFor(kStereoModels);
  options.solve.min_views_outlier = 1;
  std::vector<CameraCorners> input = cornersOf(stereoRig(), 30);
  for (observation::CameraView& image : input[0].images) {
    image.corners[image.corners.size() / 2].px.x() += 15.0;
  }
  const CalibrationResult first = calibrateCorners(input, target::AprilGrid(), options);
  ASSERT_GT(first.solution.counts[0].outliers, 10);
  const CalibrationResult second = calibrateCorners(observedCorners(first), target::AprilGrid(), options);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(camera::parameters(first.solution.rig.cameras[i].camera.model),
              camera::parameters(second.solution.rig.cameras[i].camera.model));
  }
}

TEST(CalibrateCorners, ImagesWithFewTagsStayOutOfTheSolveButAreKept) {
  std::vector<CameraCorners> cameras = cornersOf({{stereoRig().cameras[0]}}, 20);
  observation::CameraView& image = cameras[0].images[4];
  image.corners.resize(15);  // at most 15 tags' corners, in the order of ids: 2 rows of the lattice
  const target::AprilGrid grid;
  ASSERT_LT(countTags(grid, image.corners), minTags(grid));
  const CalibrationResult result = calibrateCorners(cameras, grid, optionsFor({"pinhole-radtan"}));
  const auto is_image = [&image](const observation::CameraView& other) { return other.stamp_ns == image.stamp_ns; };
  const auto unused = std::find_if(result.unused_images.begin(), result.unused_images.end(), is_image);
  ASSERT_NE(unused, result.unused_images.end());
  EXPECT_EQ(unused->corners.size(), 15U);
  EXPECT_FALSE(unused->corners[0].used);
  for (const observation::View& view : result.solution.views) {
    EXPECT_NE(view.stamp_ns, image.stamp_ns);
  }
  EXPECT_EQ(observedCorners(result)[0].images[4].stamp_ns, image.stamp_ns);
  EXPECT_EQ(result.cameras[0].num_images, 25U);
  EXPECT_EQ(result.cameras[0].num_images_detected, 20U);
  EXPECT_LE(result.cameras[0].num_images_used, 19U);

  CalibrateOptions options = optionsFor({"pinhole-radtan"});
  options.min_tags = 1;
  EXPECT_EQ(calibrateCorners(cameras, grid, options).cameras[0].num_images_used, 20U);
}

TEST(CalibrateCorners, TwoViewsGiveAResultWithAWarning) {
  const std::vector<CameraCorners> cameras = cornersOf({{stereoRig().cameras[0]}}, 2);
  const CalibrationResult result = calibrateCorners(cameras, target::AprilGrid(), optionsFor({"pinhole-radtan"}));
  const auto is_few = [](const std::string& warning) { return warning.find("only 2 views") != std::string::npos; };
  EXPECT_TRUE(std::any_of(result.warnings.begin(), result.warnings.end(), is_few));
}

TEST(CalibrateCorners, ListenersHearStagesStartsAndWarningsInOrder) {
  std::vector<std::string> heard;
  Listener listener;
  listener.progress = [&heard](const Progress& progress) {
    if (progress.done == 0) {
      heard.push_back(stageName(progress.stage));
    }
  };
  listener.camera_detected = [&heard](int index, const CameraCorners&) {
    heard.push_back("detected " + std::to_string(index));
  };
  listener.camera_started = [&heard](int index, const camera::Camera&) {
    heard.push_back("started " + std::to_string(index));
  };
  listener.rig_started = [&heard](const calibration::Problem& problem) {
    heard.push_back("rig of " + std::to_string(problem.rig.cameras.size()));
  };
  listener.detection_solved = [&heard](const CalibrationResult& result) {
    heard.push_back("solved " + std::to_string(result.cameras.size()));
  };
  std::vector<std::string> warnings;
  listener.warning = [&warnings](const std::string& warning) { warnings.push_back(warning); };
  const CalibrationResult result =
      calibrateCorners(cornersOf(stereoRig(), 6), target::AprilGrid(), optionsFor(kStereoModels), listener);
  EXPECT_EQ(heard, (std::vector<std::string>{"detected 0", "start camera", "started 0", "detected 1", "start camera",
                                             "started 1", "start rig", "rig of 2", "solve", "solved 2", "statistics"}));
  EXPECT_FALSE(warnings.empty());
  EXPECT_EQ(warnings, result.warnings);
  EXPECT_EQ(result.times.size(), 5U);
}

TEST(CalibrateCorners, CanBeCancelledDuringTheSolve) {
  Listener listener;
  bool is_solving = false;
  listener.progress = [&](const Progress& progress) {
    constexpr std::size_t kPercents = 100;
    is_solving = progress.stage == Stage::kSolve && progress.done > 0 && progress.total == kPercents;
  };
  listener.is_cancelled = [&] { return is_solving; };
  const std::vector<CameraCorners> cameras = cornersOf({{stereoRig().cameras[0]}}, 10);
  EXPECT_THROW(calibrateCorners(cameras, target::AprilGrid(), optionsFor({"pinhole-radtan"}), listener), Cancelled);
}

TEST(CalibrateCorners, ACameraWithoutTheTargetIsNamedInKalibrsWords) {
  std::vector<CameraCorners> cameras = cornersOf({{stereoRig().cameras[0]}}, 10);
  const auto run = [&] { calibrateCorners(cameras, target::AprilGrid(), optionsFor({"pinhole-radtan"})); };
  for (observation::CameraView& image : cameras[0].images) {
    image.corners.resize(6);
  }
  expectMessage<CalibrationError>(
      run, {"Could not initialize the intrinsics for camera with topic: /cam0", "7 tags", "best", "come closer"});
  cameras[0].counts.duplicate_tags = 700;
  expectMessage<CalibrationError>(run, {"7 tags", "best", "second board in view"});
  cameras[0].images.clear();
  expectMessage<CalibrationError>(run, {"none of its 15", "second board in view"});
  cameras[0].counts.mirrored_tags = 701;
  expectMessage<CalibrationError>(run, {"none of its 15", "they are mirrored"});
  cameras[0].counts = {};
  expectMessage<CalibrationError>(run,
                                  {"Could not initialize the intrinsics for camera with topic: /cam0", "none of its 15"});
}

TEST(CalibrateCorners, CamerasThatNeverShareAViewAreAnError) {
  std::vector<CameraCorners> cameras = cornersOf(stereoRig(), 20);
  for (observation::CameraView& image : cameras[1].images) {
    image.stamp_ns += 1'000'000'000'000;
  }
  EXPECT_THROW(calibrateCorners(cameras, target::AprilGrid(), optionsFor(kStereoModels)), CalibrationError);
}

TEST(CalibrateCorners, OptionsThatDoNotFitAreRejectedBeforeAnyWork) {
  const std::vector<CameraCorners> cameras = cornersOf(stereoRig(), 2);
  const auto expect_rejected = [&](const CalibrateOptions& options, std::initializer_list<std::string> parts) {
    Listener listener;
    listener.camera_detected = [](int, const CameraCorners&) { ADD_FAILURE() << "work began"; };
    expectMessage<InputError>([&] { calibrateCorners(cameras, target::AprilGrid(), options, listener); }, parts);
  };
  expect_rejected(optionsFor({"ds-none"}), {"1 models for 2 cameras"});
  expect_rejected(optionsFor({"ds-none", "fisheye"}), {"Unknown camera model: fisheye"});
  CalibrateOptions options = optionsFor(kStereoModels);
  options.approx_sync_ns = -1;
  expect_rejected(options, {"negative"});
  options = optionsFor(kStereoModels);
  options.solve.fix_intrinsics = true;
  expect_rejected(options, {"need a calibration to start from"});
  options.known_rig = calibration::Rig{{stereoRig().cameras[0]}};
  expect_rejected(options, {"has 1 cameras, there are 2"});
  options.known_rig = stereoRig();
  options.solve.fixed_cameras = {2};
  expect_rejected(options, {"no cam2 to fix", "cam0 to cam1"});
  options = optionsFor({"pinhole-radtan", "omni-none"});
  options.known_rig = stereoRig();
  expect_rejected(options, {"cam1 is to be omni-none", "has ds-none", "leave --models out", "without --init"});
}

TEST(CalibrateCorners, AKnownCameraMustBeTheSame) {
  const std::vector<CameraCorners> cameras = cornersOf(stereoRig(), 6);
  CalibrateOptions options = optionsFor(kStereoModels);
  options.known_rig = stereoRig();
  options.known_rig->cameras[0].camera.width = 640;
  expectMessage<InputError>([&] { calibrateCorners(cameras, target::AprilGrid(), options); },
                            {"cam0", "752x480", "640x480", "without --init"});
}

TEST(CalibrateCorners, QuadrilateralsNeedTags) {
  CalibrateOptions options = optionsFor({"pinhole-none"});
  options.recovery.filter = detection::CornerFilter::kQuads;
  Listener listener;
  listener.camera_detected = [](int, const CameraCorners&) { ADD_FAILURE() << "work began"; };
  const std::vector<CameraCorners> cameras(1);
  expectMessage<InputError>([&] { calibrateCorners(cameras, target::Checkerboard(), options, listener); },
                            {"AprilGrid only", "--corner-filter quads"});
}

TEST(CalibrateCorners, AFixedKnownRigKeepsItsParametersToTheBit) {
  CalibrateOptions options = optionsFor(kStereoModels);
  options.known_rig = stereoRig();
  options.solve.fix_intrinsics = true;
  options.solve.fix_extrinsics = true;
  const CalibrationResult result = calibrateCorners(cornersOf(stereoRig(), 10), target::AprilGrid(), options);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(camera::parameters(result.solution.rig.cameras[i].camera.model),
              camera::parameters(options.known_rig->cameras[i].camera.model));
    EXPECT_EQ(result.solution.rig.cameras[i].T_cam_rig.translation, options.known_rig->cameras[i].T_cam_rig.translation);
  }
  EXPECT_NEAR(result.cameras[0].statistics.rms_px, kNoise_px * std::sqrt(2.0), 0.01);
}

TEST(CalibrateCorners, CornersOfAnotherTargetOrOutOfOrderAreRejected) {
  std::vector<CameraCorners> cameras = cornersOf({{stereoRig().cameras[0]}}, 4);
  target::AprilGrid small;
  small.tag_rows = 3;
  expectMessage<InputError>([&] { calibrateCorners(cameras, small, optionsFor({"pinhole-radtan"})); },
                            {"cam0, image ", "no corner ", "it has 72"});
  std::swap(cameras[0].images[0], cameras[0].images[1]);
  expectMessage<InputError>([&] { calibrateCorners(cameras, target::AprilGrid(), optionsFor({"pinhole-radtan"})); },
                            {"cam0, image ", "increase"});
}

TEST(Calibrate, FromImagesRecoversTheLensWhateverTheNumberOfThreads) {
  const Pinhole pinhole;
  const CameraStream stream = streamOf(boardImages(12, pinhole));
  CalibrateOptions options = optionsFor({"pinhole-none"});
  const CalibrationResult one = calibrate({stream}, smallGrid(), options);
  options.num_threads = 3;
  const CalibrationResult three = calibrate({stream}, smallGrid(), options);
  const Eigen::VectorXd parameters = camera::parameters(one.solution.rig.cameras[0].camera.model);
  EXPECT_EQ(parameters, camera::parameters(three.solution.rig.cameras[0].camera.model));
  // The pictures are good to some tenths of a pixel only.
  EXPECT_NEAR(parameters(0), pinhole.focal_px, 0.01 * pinhole.focal_px);
  EXPECT_NEAR(parameters(2), 319.5, 4.0);
  EXPECT_EQ(one.cameras[0].num_images_used, 12U);
  EXPECT_EQ(one.times.size(), 5U + 3U * one.rounds.size());
  EXPECT_EQ(one.times[0].stage, Stage::kDetect);
}

/// Two copies of the board, each at half of its size.
StampedImage doubled(const StampedImage& image, std::int64_t stamp_ns) {
  cv::Mat half;
  cv::resize(image.load(), half, cv::Size(), 0.5, 0.5, cv::INTER_AREA);
  cv::Mat both(2 * half.rows, 2 * half.cols, CV_8UC1, cv::Scalar(128));
  half.copyTo(both(cv::Rect(0, half.rows / 2, half.cols, half.rows)));
  half.copyTo(both(cv::Rect(half.cols, half.rows / 2, half.cols, half.rows)));
  return {stamp_ns, [both] { return both; }};
}

TEST(Calibrate, ImagesWithEveryTagTwiceAreLeftOutAndTold) {
  std::vector<StampedImage> images = boardImages(12);
  for (int i = 0; i < 3; ++i) {
    images.push_back(doubled(images[static_cast<std::size_t>(i)], images.back().stamp_ns + kPeriod_ns));
  }
  const CalibrationResult result = calibrate({streamOf(images)}, smallGrid(), optionsFor({"pinhole-none"}));
  EXPECT_EQ(result.cameras[0].num_images_used, 12U);
  const Eigen::VectorXd parameters = camera::parameters(result.solution.rig.cameras[0].camera.model);
  EXPECT_NEAR(parameters(0), Pinhole().focal_px, 0.01 * Pinhole().focal_px);
  const auto tells = [](const std::string& text) { return text.find("their id was there twice") != std::string::npos; };
  EXPECT_TRUE(std::any_of(result.warnings.begin(), result.warnings.end(), tells));
}

TEST(Calibrate, ImagesOfAnotherSizeThanTheKnownCamerasAreRejectedBeforeTheDetection) {
  CalibrateOptions options = optionsFor({"pinhole-none"});
  options.known_rig = calibration::Rig{{{cameraOf("pinhole-none", {400, 400, 376, 240}), geometry::Rigid3()}}};
  Listener listener;
  listener.progress = [](const Progress&) { ADD_FAILURE() << "work began"; };
  const std::vector<CameraStream> streams = {streamOf(boardImages(3))};
  expectMessage<InputError>([&] { calibrate(streams, smallGrid(), options, listener); },
                            {"cam0 has images of 640x480", "752x480", "without --init"});
}

TEST(Calibrate, AFirstImageOfAnotherSizeThanTheKnownCamerasIsSkippedAsAnyOther) {
  std::vector<StampedImage> images = boardImages(12);
  cv::Mat small(100, 100, CV_8UC1, cv::Scalar(128));
  images.front().load = [small] { return small; };
  CalibrateOptions options = optionsFor({"pinhole-none"});
  camera::Camera known = cameraOf("pinhole-none", {400, 400, 319.5, 239.5});
  known.width = 640;
  options.known_rig = calibration::Rig{{{known, geometry::Rigid3()}}};
  options.max_rounds = 0;
  EXPECT_EQ(calibrate({streamOf(images)}, smallGrid(), options).cameras[0].num_images_used, 11U);
}

TEST(Calibrate, ATopicWithoutReadableImagesIsAnError) {
  CameraStream stream;
  stream.topic = "/cam0/image_raw";
  stream.open = [] { return []() -> std::optional<StampedImage> { return std::nullopt; }; };
  const auto run = [&] { calibrate({stream}, target::AprilGrid(), optionsFor({"pinhole-radtan"})); };
  expectMessage<InputError>(run, {"/cam0/image_raw", "no images"});
  stream.open = [] {
    return [done = false]() mutable -> std::optional<StampedImage> {
      const StampedImage image{1, []() -> cv::Mat { throw InputError("truncated JPEG"); }};
      return std::exchange(done, true) ? std::nullopt : std::optional<StampedImage>(image);
    };
  };
  expectMessage<InputError>(run, {"/cam0/image_raw", "truncated JPEG"});
}

TEST(CountTags, CountsTagsOfWhichACornerWasSeen) {
  const target::AprilGrid grid;
  const auto corners = [](const std::vector<int>& ids) {
    std::vector<observation::Corner> result;
    for (const int id : ids) {
      result.push_back({id});
    }
    return result;
  };
  EXPECT_EQ(countTags(grid, {}), 0);
  EXPECT_EQ(countTags(grid, corners(target::tagCornerIds(grid, 35))), 1);
  EXPECT_EQ(countTags(grid, corners({0, 13, 2, 24})), 3);
  EXPECT_EQ(minTags(grid), 7);
}

TEST(CalibrateCorners, SaysWhereAMovingPupilExplainsTheResiduals) {
  calibration::Rig rig{{{cameraOf("ds-none", {-0.2, 0.55, 300, 301, 379, 255}), geometry::Rigid3()}}};
  const auto is_hint = [](const std::string& warning) {
    return warning.find("--estimate-pupil-shift") != std::string::npos &&
           warning.find("cannot follow the lens (try pinhole-equi or omni-radtan)") != std::string::npos;
  };
  for (const double shift_m : {0.0, 0.05}) {
    rig.cameras[0].camera.pupil.coefficients_m.x() = shift_m;
    const std::vector<CameraCorners> corners = cornersOf(rig, 30);
    CalibrateOptions options = optionsFor({"ds-none"});
    const CalibrationResult central = calibrateCorners(corners, target::AprilGrid(), options);
    EXPECT_EQ(std::count_if(central.warnings.begin(), central.warnings.end(), is_hint), shift_m > 0.0 ? 1 : 0) << shift_m;
    options.solve.estimate_pupil_shift = true;
    const CalibrationResult moving = calibrateCorners(corners, target::AprilGrid(), options);
    EXPECT_EQ(std::count_if(moving.warnings.begin(), moving.warnings.end(), is_hint), 0) << shift_m;
    EXPECT_NEAR(moving.solution.sigma_px, kNoise_px, 0.1 * kNoise_px) << shift_m;
  }
}

}  // namespace
}  // namespace tartan_calib::pipeline
