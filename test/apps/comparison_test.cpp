#include "compare_camchains/comparison.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

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
  for (const CameraComparison& comparison : compareRigs(rig, rig, kWide)) {
    EXPECT_LT(comparison.max_px, 1e-9);
    EXPECT_LT(comparison.rotation_rad, 1e-12);
    EXPECT_EQ(comparison.translation_m, 0.0);
  }
}

TEST(CompareRigs, AnotherPlaceOnTheRigIsToldInRadiansAndMetres) {
  const calibration::Rig rig{{fisheye(200.0), fisheye(200.0)}};
  calibration::Rig moved = rig;
  geometry::Vector6d twist = geometry::Vector6d::Zero();
  twist.tail<3>() << 0.0, 2e-3, 0.0;
  moved.cameras[1].T_cam_rig = geometry::expRigid(twist);
  moved.cameras[1].T_cam_rig.translation.x() = 5e-3;
  const auto comparisons = compareRigs(rig, moved, kWide);
  EXPECT_LT(comparisons[0].rotation_rad, 1e-12);
  EXPECT_NEAR(comparisons[1].rotation_rad, 2e-3, 1e-9);
  EXPECT_NEAR(comparisons[1].translation_m, 5e-3, 1e-12);
}

TEST(CompareRigs, ALongerFocalLengthShowsMostAtTheRim) {
  const auto comparison = compareRigs({{fisheye(200.0)}}, {{fisheye(202.0)}}, kWide).front();
  EXPECT_GT(comparison.max_px, 1.5 * comparison.rms_px);
  const auto narrow = compareRigs({{fisheye(200.0)}}, {{fisheye(202.0)}}, {0.2, std::nullopt, {}}).front();
  EXPECT_LT(narrow.max_px, 0.3 * comparison.max_px);
}

TEST(CompareRigs, TheDifferenceIsInPixels) {
  constexpr double kAngle_rad = 0.2;
  const auto comparison = compareRigs({{fisheye(200.0)}}, {{fisheye(202.0)}}, {kAngle_rad, std::nullopt, {}}).front();
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
  const double everywhere_px = compareRigs(a, b, kWide).front().max_px;
  const ComparisonRegion middle{1.5, std::nullopt, {recordingOf({centre, rim}), recordingOf({centre})}};
  EXPECT_LT(compareRigs(a, b, middle).front().max_px, 0.3 * everywhere_px);
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
  const std::string text = comparisonText(a, b, kWide);
  for (const char* part :
       {"cam0, ds-none and ds-none", "cam1, ds-none and ds-none", "projection to 85.9 degrees: differs by 0.000000 px",
        "place on the rig: differs by 0.000000 mrad and 5.000000 mm"}) {
    EXPECT_NE(text.find(part), std::string::npos) << part << " is not in\n" << text;
  }
}

}  // namespace
}  // namespace tartan_calib::apps
