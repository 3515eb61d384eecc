#include "compare_calibrations/comparison.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <utility>

#include "compare_calibrations/difference_map.h"
#include "tartan_calib/error.h"

namespace tartan_calib::apps {
namespace {

const ComparisonRegion kWide{1.5, std::nullopt, {}};

calibration::RigCamera fisheye(double focal_px) {
  calibration::RigCamera camera;
  camera.camera.model = camera::startModel(camera::modelByName("ds-none"), focal_px, {319.5, 239.5});
  camera.camera.width = 640;
  camera.camera.height = 480;
  return camera;
}

TEST(CompareRigs, ARigIsNoWayFromItself) {
  const calibration::Rig rig{{fisheye(200.0), fisheye(210.0)}};
  const RigComparison comparison = compareRigs(rig, rig, kWide);
  for (const CameraComparison& camera : comparison.cameras) {
    EXPECT_LT(camera.projection.max_px, 1e-9);
  }
  EXPECT_LT(comparison.pairs.front().difference.rotation_rad, 1e-12);
  EXPECT_EQ(comparison.pairs.front().difference.translation_m, 0.0);
}

TEST(CompareRigs, AnotherPlaceOnTheRigIsToldInRadiansAndMetres) {
  const calibration::Rig rig{{fisheye(200.0), fisheye(200.0)}};
  calibration::Rig moved = rig;
  geometry::Vector6d twist = geometry::Vector6d::Zero();
  twist.tail<3>() << 0.0, 2e-3, 0.0;
  moved.cameras[1].T_cam_rig = geometry::expRigid(twist);
  moved.cameras[1].T_cam_rig.translation.x() = 5e-3;
  const auto pairs = compareRigs(rig, moved, kWide).pairs;
  ASSERT_EQ(pairs.size(), 1U);
  for (const MotionSize& size : {pairs[0].difference, pairs[0].difference_without_frames}) {
    EXPECT_NEAR(size.rotation_rad, 2e-3, 1e-9);
    EXPECT_NEAR(size.translation_m, 5e-3, 1e-9);
  }
}

TEST(CompareRigs, EveryTwoCamerasAreCompared) {
  const calibration::Rig rig{{fisheye(200.0), fisheye(200.0), fisheye(200.0)}};
  calibration::Rig moved = rig;
  moved.cameras[2].T_cam_rig.translation.x() = 5e-3;
  const auto pairs = compareRigs(rig, moved, kWide).pairs;
  ASSERT_EQ(pairs.size(), 3U);
  EXPECT_EQ(pairs[0].difference.translation_m, 0.0);
  EXPECT_NEAR(pairs[1].difference.translation_m, 5e-3, 1e-12);
  EXPECT_NEAR(pairs[2].difference.translation_m, 5e-3, 1e-12);
  EXPECT_EQ(std::make_pair(pairs[2].first, pairs[2].second), std::make_pair(1, 2));
}

TEST(CompareRigs, ACameraFrameTurnedBehindItsLensIsNoOtherPlaceOnTheRig) {
  const calibration::Rig rig{{fisheye(200.0), fisheye(200.0)}};
  // A principal point of a narrow field of view moves as if the camera were turned, by which the rig's file makes up.
  const ComparisonRegion narrow{0.05, std::nullopt, {}};
  constexpr double kShift_px = 1.0;
  calibration::Rig turned = rig;
  Eigen::VectorXd parameters = camera::parameters(rig.cameras[1].camera.model);
  parameters(4) += kShift_px;
  turned.cameras[1].camera.model = camera::withParameters(rig.cameras[1].camera.model, parameters);
  turned.cameras[1].T_cam_rig = compareRigs(rig, turned, narrow).cameras[1].projection.T_b_a;
  const PairComparison pair = compareRigs(rig, turned, narrow).pairs.front();
  EXPECT_GT(pair.difference.rotation_rad, 0.9 * kShift_px / 200.0);
  EXPECT_LT(pair.difference_without_frames.rotation_rad, 1e-6);
}

TEST(CompareRigs, BandsOfPolarAngleHoldAllPixels) {
  const CameraComparison camera = compareRigs({{fisheye(200.0)}}, {{fisheye(202.0)}}, kWide).cameras.front();
  int num_pixels = 0;
  double sum_px2 = 0.0;
  double max_px = 0.0;
  for (const DifferenceBand& band : camera.bands) {
    num_pixels += band.num_pixels;
    sum_px2 += band.num_pixels * band.rms_px * band.rms_px;
    max_px = std::max(max_px, band.max_px);
    EXPECT_LE(band.mean_px, band.rms_px);
  }
  EXPECT_EQ(num_pixels, static_cast<int>(camera.projection.pixels.size()));
  EXPECT_NEAR(std::sqrt(sum_px2 / num_pixels), camera.projection.rms_px, 1e-9);
  EXPECT_EQ(max_px, camera.projection.max_px);
  EXPECT_LT(camera.bands[0].rms_px, 0.1 * camera.bands.back().rms_px);
}

TEST(CompareRigs, ALongerFocalLengthShowsMostAtTheRim) {
  const auto comparison = compareRigs({{fisheye(200.0)}}, {{fisheye(202.0)}}, kWide).cameras.front().projection;
  EXPECT_GT(comparison.max_px, 1.5 * comparison.rms_px);
  const auto narrow =
      compareRigs({{fisheye(200.0)}}, {{fisheye(202.0)}}, {0.2, std::nullopt, {}}).cameras.front().projection;
  EXPECT_LT(narrow.max_px, 0.3 * comparison.max_px);
}

TEST(CompareRigs, TheDifferenceIsInPixels) {
  constexpr double kAngle_rad = 0.2;
  const auto comparison =
      compareRigs({{fisheye(200.0)}}, {{fisheye(202.0)}}, {kAngle_rad, std::nullopt, {}}).cameras.front().projection;
  // The start of a double sphere maps an angle a to 2 tan(a / 2); the grid ends within a cell of the largest angle.
  EXPECT_NEAR(comparison.max_px, 2.0 * 2.0 * std::tan(0.5 * kAngle_rad), 0.03);
}

/// One corner at each of these pixels.
std::vector<pipeline::CameraCorners> recordingOf(const std::vector<Eigen::Vector2d>& pixels) {
  pipeline::CameraCorners corners;
  corners.images.emplace_back();
  for (const Eigen::Vector2d& px : pixels) {
    corners.images.back().corners.push_back({0, px, Eigen::Matrix2d::Identity(), true});
  }
  return {corners};
}

TEST(CompareRigs, OnlyPixelsNearWhichEveryRecordingHasCornersCount) {
  const calibration::Rig a{{fisheye(200.0)}};
  const calibration::Rig b{{fisheye(202.0)}};
  const Eigen::Vector2d centre(325.0, 245.0);
  const Eigen::Vector2d rim(20.0, 20.0);
  const double everywhere_px = compareRigs(a, b, kWide).cameras.front().projection.max_px;
  const ComparisonRegion middle{1.5, std::nullopt, {recordingOf({centre, rim}), recordingOf({centre})}};
  EXPECT_LT(compareRigs(a, b, middle).cameras.front().projection.max_px, 0.3 * everywhere_px);
  std::vector<pipeline::CameraCorners> rejected = recordingOf({centre});
  rejected[0].images[0].corners[0].used = false;
  EXPECT_THROW(compareRigs(a, b, {1.5, std::nullopt, {rejected}}), CalibrationError);
}

TEST(CompareRigs, OtherRigsAreRefused) {
  EXPECT_THROW(compareRigs({{fisheye(200.0)}}, {}, kWide), InputError);
  calibration::Rig larger{{fisheye(200.0)}};
  larger.cameras[0].camera.width = 1000;
  EXPECT_THROW(compareRigs({{fisheye(200.0)}}, larger, kWide), InputError);
  EXPECT_THROW(compareRigs({{fisheye(200.0)}}, {{fisheye(200.0)}}, {1.5, std::nullopt, {{}}}), InputError);
}

TEST(ComparisonText, NamesEveryCameraAndItsDifferences) {
  io::Camchain a;
  a.rig.cameras = {fisheye(200.0), fisheye(210.0)};
  io::Camchain b = a;
  b.rig.cameras[1].T_cam_rig.translation.x() = 5e-3;
  const std::string text = comparisonText(a, b, kWide, compareRigs(a.rig, b.rig, kWide));
  for (const char* part :
       {"cam0, ds-none and ds-none", "cam1, ds-none and ds-none", "projection to 85.9 degrees: differs by 0.000000 px",
        "cam1 on cam0: place differs by 0.000000 mrad and 5.000000 mm", "80 to  90"}) {
    EXPECT_NE(text.find(part), std::string::npos) << part << " is not in\n" << text;
  }
}

TEST(ComparisonText, SaysThatExtrinsicsAreMissing) {
  io::Camchain a;
  a.rig.cameras = {fisheye(200.0), fisheye(210.0)};
  a.has_extrinsics = false;
  const std::string text = comparisonText(a, a, kWide, compareRigs(a.rig, a.rig, kWide));
  EXPECT_EQ(text.find("place differs"), std::string::npos);
  EXPECT_NE(text.find("no extrinsics"), std::string::npos);
}

TEST(DifferenceMap, IsLightWhereTheCalibrationsDifferAndDarkWhereNot) {
  io::Camchain a;
  a.rig.cameras = {fisheye(200.0)};
  io::Camchain b;
  b.rig.cameras = {fisheye(202.0)};
  const cv::Mat map = differenceMap(a, b, kWide, compareRigs(a.rig, b.rig, kWide));
  ASSERT_EQ(map.type(), CV_8UC3);
  // Viridis runs from dark blue to yellow. The area of the image begins at (64, 46) and is 760 px wide.
  const auto brightness = [&](int u, int v) {
    return cv::sum(map(cv::Rect(64 + u * 760 / 640, 46 + v * 760 / 640, 3, 3)))[1];
  };
  EXPECT_LT(brightness(320, 250), 0.5 * brightness(40, 240));
}

TEST(DifferenceMap, TwoCamerasAreSideBySide) {
  io::Camchain one;
  one.rig.cameras = {fisheye(200.0)};
  io::Camchain two;
  two.rig.cameras = {fisheye(200.0), fisheye(210.0)};
  const cv::Mat narrow = differenceMap(one, one, kWide, compareRigs(one.rig, one.rig, kWide));
  const cv::Mat wide = differenceMap(two, two, kWide, compareRigs(two.rig, two.rig, kWide));
  EXPECT_EQ(wide.cols, 2 * narrow.cols);
  EXPECT_EQ(wide.rows, narrow.rows);
}

}  // namespace
}  // namespace tartan_calib::apps
