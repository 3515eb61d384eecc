#include "validate_calibration/validation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

#include "common/program.h"
#include "support/expect_message.h"
#include "support/simulated_scene.h"
#include "support/temporary_folder.h"
#include "validate_calibration/error_picture.h"
#include "validate_calibration/validate_options.h"

namespace tartan_calib::apps {
namespace {

using test_support::expectMessage;

constexpr double kNoise_px = 0.1;
constexpr double kNoiseRms_px = 0.1414;
const ProgressCall kQuiet = [](std::size_t /*done*/, std::size_t /*total*/) {};

/// Two cameras before a board in 20 views, with noise on the corners.
struct StereoRecording {
  StereoRecording() {
    test_support::Random random(3);
    calibration::Rig rig;
    for (int i = 0; i < 2; ++i) {
      rig.cameras.push_back({test_support::randomCamera("ds-none", 3.2, 1224, 1024, random),
                             geometry::Rigid3(Eigen::Quaterniond::Identity(), Eigen::Vector3d(-0.1 * i, 0.0, 0.0))});
    }
    test_support::SceneOptions options;
    options.num_views = 20;
    scene = test_support::simulateScene(rig, options);
    test_support::addNoise(scene.views, kNoise_px, 4);
    for (int i = 0; i < 2; ++i) {
      pipeline::CameraCorners camera;
      camera.topic = "/cam" + std::to_string(i) + "/image_raw";
      camera.width = 1224;
      camera.height = 1024;
      camera.images = test_support::viewsOf(scene.views, i);
      camera.num_images = camera.images.size() + 3;
      corners.push_back(camera);
    }
  }

  Validation validated(const calibration::Rig& rig) const { return validate(rig, target, corners, 20'000'000, kQuiet); }

  target::Target target = target::AprilGrid{};
  test_support::Scene scene;
  std::vector<pipeline::CameraCorners> corners;
};

void expectRms(Validation& validation, double expected_px) {
  for (CameraValidation& camera : validation.cameras) {
    camera.expected_px = expected_px;
  }
}

bool mentions(const Judgement& judgement, const std::string& part) {
  return std::any_of(judgement.reasons.begin(), judgement.reasons.end(),
                     [&](const std::string& reason) { return reason.find(part) != std::string::npos; });
}

TEST(Validation, ARightCalibrationHolds) {
  const StereoRecording recording;
  Validation validation = recording.validated(recording.scene.rig);
  EXPECT_EQ(validation.num_unexplained, 0U);
  EXPECT_GT(validation.num_joint, 10U);
  for (const CameraValidation& camera : validation.cameras) {
    EXPECT_NEAR(camera.together.errors.rms_px, kNoiseRms_px, 0.1 * kNoiseRms_px);
    EXPECT_EQ(camera.num_images, camera.images.size() + 3);
  }
  EXPECT_EQ(judge(validation).fit, Fit::kUnknown);
  expectRms(validation, kNoiseRms_px);
  EXPECT_EQ(judge(validation).fit, Fit::kHolds);
  EXPECT_FALSE(mentions(judge(validation), "place on the rig"));
}

TEST(Validation, AMovedCameraIsToldFromAWrongLens) {
  const StereoRecording recording;
  calibration::Rig moved = recording.scene.rig;
  moved.cameras[1].T_cam_rig.translation.y() += 5e-3;
  Validation validation = recording.validated(moved);
  expectRms(validation, kNoiseRms_px);
  EXPECT_EQ(judge(validation).fit, Fit::kFails);
  EXPECT_TRUE(mentions(judge(validation), "place on the rig"));

  calibration::Rig other_lens = recording.scene.rig;
  camera::CameraModel& model = other_lens.cameras[0].camera.model;
  Eigen::VectorXd parameters = camera::parameters(model);
  parameters.segment<2>(camera::focalIndex(model)) *= 1.02;
  model = camera::withParameters(model, parameters);
  validation = recording.validated(other_lens);
  expectRms(validation, kNoiseRms_px);
  EXPECT_EQ(judge(validation).fit, Fit::kFails);
  EXPECT_GT(validation.cameras[0].alone.errors.rms_px, 3.0 * kNoiseRms_px);
  EXPECT_LT(validation.cameras[1].alone.errors.rms_px, 1.1 * kNoiseRms_px);
}

TEST(Validation, WhatDoesNotBelongTogetherIsRefused) {
  StereoRecording recording;
  calibration::Rig one = recording.scene.rig;
  one.cameras.pop_back();
  expectMessage<InputError>([&] { recording.validated(one); }, {"1 cameras", "2"});
  recording.corners[1].width = 640;
  expectMessage<InputError>([&] { recording.validated(recording.scene.rig); }, {"cam1", "640x1024", "1224x1024"});
  recording.corners[1].width = 1224;
  recording.corners[0].images[0].corners[0].corner_id = 144;
  expectMessage<InputError>([&] { recording.validated(recording.scene.rig); }, {"cam0", "corner 144", "144 corners"});
}

TEST(Validation, NoBoardIsNoResult) {
  StereoRecording recording;
  for (pipeline::CameraCorners& camera : recording.corners) {
    camera.images.clear();
  }
  expectMessage<CalibrationError>([&] { recording.validated(recording.scene.rig); }, {"no image shows the target"});
}

TEST(Validation, CamerasThatNeverSeeTheBoardTogetherLeaveExtrinsicsUntested) {
  StereoRecording recording;
  for (observation::CameraView& image : recording.corners[1].images) {
    image.stamp_ns += 25'000'000;
  }
  const Validation validation = recording.validated(recording.scene.rig);
  EXPECT_EQ(validation.num_joint, 0U);
  EXPECT_TRUE(mentions(judge(validation), "extrinsics are not tested"));
}

TEST(Validation, ALensThatIsWrongAtTheRimIsToldSo) {
  const StereoRecording recording;
  calibration::Rig bent = recording.scene.rig;
  camera::CameraModel& model = bent.cameras[0].camera.model;
  Eigen::VectorXd parameters = camera::parameters(model);
  parameters(1) += 0.05;  // alpha: the same scale in the middle
  model = camera::withParameters(model, parameters);
  const Judgement judgement = judge(recording.validated(bent));
  EXPECT_TRUE(mentions(judgement, "cam0: largest from"));
  EXPECT_FALSE(mentions(judgement, "cam1: largest from"));
}

TEST(Validation, ViewsAndCornersThatTheCalibrationCannotExplainAreTold) {
  StereoRecording recording;
  for (std::size_t i = 0; i < 5; ++i) {
    recording.corners[0].images[i].corners.resize(3);
    recording.corners[1].images.erase(recording.corners[1].images.begin());
  }
  const Validation validation = recording.validated(recording.scene.rig);
  EXPECT_GT(validation.num_unexplained, 0U);
  EXPECT_TRUE(mentions(judge(validation), "no pose of the board explains"));
}

TEST(ValidationText, HasErrorsByCameraAndBandWorstImagesAndVerdict) {
  const StereoRecording recording;
  Validation validation = recording.validated(recording.scene.rig);
  expectRms(validation, kNoiseRms_px);
  const std::string text = validationText(validation);
  for (const char* part : {"cam0 (/cam0/image_raw), ds-none", "cam1 (", "one pose for the rig", "this camera alone",
                           "10 to 20 degrees", "worst images\n  cam", "Verdict: the calibration holds\n"}) {
    EXPECT_NE(text.find(part), std::string::npos) << part << " is not in\n" << text;
  }
}

TEST(ErrorsCsv, HasALineForEveryCorner) {
  const StereoRecording recording;
  const Validation validation = recording.validated(recording.scene.rig);
  int num_corners = 0;
  for (const CameraValidation& camera : validation.cameras) {
    num_corners += camera.together.errors.num_corners + camera.together.num_wrong;
  }
  const std::string text = errorsCsv(validation);
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), num_corners + 1);
  EXPECT_EQ(text.find("camera,stamp_ns,corner_id,u_px,v_px,error_u_px,error_v_px,polar_deg,wrong\n0,50000000,"), 0U);
}

TEST(ErrorPicture, ShowsEveryCameraInTheSameColours) {
  const StereoRecording recording;
  const cv::Mat picture = errorPicture(recording.validated(recording.scene.rig));
  ASSERT_EQ(picture.type(), CV_8UC3);
  const cv::Mat left = picture.colRange(0, picture.cols / 2);
  const cv::Mat right = picture.colRange(picture.cols / 2, picture.cols);
  // The bars beside the two images, with their numbers.
  const cv::Rect bars(left.cols - 95, 40, 90, 300);
  EXPECT_EQ(cv::norm(left(bars), right(bars), cv::NORM_INF), 0.0);
  EXPECT_GT(cv::norm(left, right, cv::NORM_INF), 0.0);
}

TEST(ResidualsBeside, ReadsWhatKalibrWritesUnderBothNames) {
  const test_support::TemporaryFolder folder;
  for (const char* name : {"rig-results-cam.txt", "results-cam-old.txt"}) {
    std::ofstream(folder.file(name)) << "cam0 (/a):\n    reprojection error: [-0.000008, 0.000001] +- [0.3, 0.4]\n"
                                     << "cam1 (/b):\n    reprojection error: [0.0, 0.0] +- [0.05, 0.12]\n";
  }
  for (const char* name : {"rig-camchain.yaml", "camchain-old.yaml"}) {
    const std::vector<double> residuals_px = residualsBeside(folder.file(name), 2);
    ASSERT_EQ(residuals_px.size(), 2U) << name;
    EXPECT_NEAR(residuals_px[0], 0.5, 1e-6);
    EXPECT_NEAR(residuals_px[1], 0.13, 1e-6);
    EXPECT_TRUE(residualsBeside(folder.file(name), 3).empty());
  }
  EXPECT_TRUE(residualsBeside(folder.file("other-camchain.yaml"), 2).empty());
  EXPECT_TRUE(residualsBeside("calibration", 2).empty());
}

TEST(ValidateOptions, NeedOneSourceOfCorners) {
  EXPECT_EQ(
      parseValidateOptions({"--bag", "b", "--camchain", "c", "--target", "t", "--approx-sync", "0.01"})->approx_sync_ns,
      10'000'000);
  EXPECT_EQ(parseValidateOptions({"--corners", "x.csv", "--camchain", "c", "--target", "t"})->corners_file, "x.csv");
  EXPECT_THROW(parseValidateOptions({"--camchain", "c", "--target", "t"}), UsageError);
  EXPECT_THROW(parseValidateOptions({"--bag", "b", "--corners", "x.csv", "--camchain", "c", "--target", "t"}), UsageError);
  EXPECT_THROW(parseValidateOptions({"--bag", "b", "--camchain", "c", "--target", "t", "--expected-px", "0"}), UsageError);
  EXPECT_FALSE(parseValidateOptions({"-h"}).has_value());
}

}  // namespace
}  // namespace tartan_calib::apps
