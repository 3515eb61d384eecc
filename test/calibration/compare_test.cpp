#include "tartan_calib/calibration/compare.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tartan_calib/error.h"
#include "tartan_calib/geometry/rigid3.h"

namespace tartan_calib::calibration {
namespace {

camera::CameraModel doubleSphere(double cu_px, double fu_px = 313.0) {
  Eigen::VectorXd parameters(6);
  parameters << -0.18, 0.59, fu_px, fu_px, cu_px, 512.0;
  return camera::withParameters(camera::modelByName("ds-none"), parameters);
}

TEST(CompareTest, TheSameCalibrationDiffersNowhere) {
  const ProjectionDifference difference =
      compareProjections(doubleSphere(640.0), doubleSphere(640.0), imageGrid(1280, 1024, 40.0));
  EXPECT_LT(difference.max_px, 1e-9);
  EXPECT_LT(difference.T_b_a.rotation.angularDistance(Eigen::Quaterniond::Identity()), 1e-12);
}

TEST(CompareTest, TwoFormulasOfOneLensAreTheSame) {
  // The unified model, written as omni and as EUCM with beta = 1.
  Eigen::VectorXd omni(5);
  omni << 0.8, 600.0, 600.0, 640.0, 512.0;
  Eigen::VectorXd eucm(6);
  eucm << 0.8 / 1.8, 1.0, 600.0 / 1.8, 600.0 / 1.8, 640.0, 512.0;
  const ProjectionDifference difference =
      compareProjections(camera::withParameters(camera::modelByName("omni-none"), omni),
                         camera::withParameters(camera::modelByName("eucm-none"), eucm), imageGrid(1280, 1024, 40.0));
  EXPECT_LT(difference.max_px, 1e-8);
}

TEST(CompareTest, AShiftedPrincipalPointIsTakenUpByARotationUpToWhatTheLensBends) {
  const ProjectionDifference narrow =
      compareProjections(doubleSphere(640.0), doubleSphere(641.0), {{638.0, 510.0}, {642.0, 510.0}, {640.0, 514.0}});
  EXPECT_LT(narrow.max_px, 1e-3);
  EXPECT_NEAR(narrow.T_b_a.rotation.angularDistance(Eigen::Quaterniond::Identity()), 1.0 / 313.0, 1.0 / 313.0);
  const ProjectionDifference wide =
      compareProjections(doubleSphere(640.0), doubleSphere(641.0), imageGrid(1280, 1024, 40.0));
  EXPECT_GT(wide.rms_px, 0.01);
  EXPECT_LT(wide.rms_px, 1.0);
}

TEST(CompareTest, AScaleErrorShowsAsDifferenceGrowingFromTheCentre) {
  const ProjectionDifference difference =
      compareProjections(doubleSphere(640.0), doubleSphere(640.0, 316.13), imageGrid(1280, 1024, 64.0));
  double centre_px = 1e9;
  for (const PixelDifference& pixel : difference.pixels) {
    if ((pixel.px - Eigen::Vector2d(640.0, 512.0)).norm() < 60.0) {
      centre_px = std::min(centre_px, pixel.difference_px.norm());
    }
  }
  EXPECT_LT(centre_px, 0.6);
  EXPECT_GT(difference.max_px, 5.0);
}

TEST(CompareTest, AtADistanceACameraFrameFartherBackIsTheSameCalibration) {
  // Two lenses that differ: what a motion of 2 mm along the axis does to points at 50 mm, a longer focal length does nearly
  // too.
  const auto grid = imageGrid(1280, 1024, 40.0);
  const double infinite_px = compareProjections(doubleSphere(640.0), doubleSphere(640.0, 316.13), grid).rms_px;
  const ProjectionDifference near = compareProjections(doubleSphere(640.0), doubleSphere(640.0, 316.13), grid, 0.05);
  EXPECT_LT(near.rms_px, 0.7 * infinite_px);
  EXPECT_GT(std::abs(near.T_b_a.translation.z()), 1e-4);
  EXPECT_LT(near.T_b_a.translation.head<2>().norm(), 1e-5);
}

TEST(CompareTest, NothingToCompareIsAnError) {
  EXPECT_THROW(compareProjections(doubleSphere(640.0), doubleSphere(640.0), {}), CalibrationError);
  EXPECT_THROW(compareProjections(doubleSphere(640.0), doubleSphere(640.0), {{1e6, 0.0}, {0.0, 1e6}, {1e6, 1e6}}),
               CalibrationError);
}

TEST(CompareTest, TheGridIsCentredAndInsideTheImage) {
  const std::vector<Eigen::Vector2d> grid = imageGrid(101, 51, 20.0);
  ASSERT_EQ(grid.size(), 6U * 3U);
  EXPECT_EQ(grid.front(), Eigen::Vector2d(0.0, 5.0));
  EXPECT_EQ(grid.back(), Eigen::Vector2d(100.0, 45.0));
}

}  // namespace
}  // namespace tartan_calib::calibration
