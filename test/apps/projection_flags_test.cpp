#include "calibrate_cameras/projection_flags.h"

#include <gtest/gtest.h>

#include "common/program.h"
#include "support/expect_message.h"

namespace tartan_calib::apps {
namespace {

using Words = std::vector<std::string>;

constexpr double kDegree = 3.14159265358979323846 / 180.0;

pipeline::Projections parsed(const Words& words) { return projectionsFrom(parseFlags(words)); }

void expectUsageError(const Words& words, const std::string& part) {
  test_support::expectMessage<UsageError>([&words] { parsed(words); }, {part});
}

TEST(ProjectionFlags, AreNoneByDefault) {
  EXPECT_TRUE(parsed({}).empty());
  EXPECT_TRUE(parsed({"--projections", "none"}).empty());
  EXPECT_TRUE(parsed({"--projections", "cornerpredictor"}).empty());
}

TEST(ProjectionFlags, HaveTartanCalibsDefaults) {
  const pipeline::Projections projections = parsed({"--projections", "pinhole"});
  ASSERT_EQ(projections.pinholes.size(), 1U);
  const pipeline::VirtualPinhole& pinhole = projections.pinholes[0];
  EXPECT_TRUE(pinhole.R_cam_view.col(2).isApprox(-Eigen::Vector3d::UnitY(), 1e-12));
  EXPECT_EQ(pinhole.width, 1000);
  EXPECT_EQ(pinhole.height, 1000);
  EXPECT_NEAR(pinhole.focal_px.x(), 999.0 / 2.0, 1e-9);  // 90 degrees
}

TEST(ProjectionFlags, ReadRowsAsTartanCalibDoes) {
  const pipeline::Projections projections =
      parsed({"--projections", "pinhole", "homography", "pinhole", "--fovs",        "90",  "80",  "100",
              "--fovs",        "70",      "80",         "60",      "--poses",       "0",   "0",   "90",
              "--poses",       "0",       "0",          "-90",     "--resolutions", "300", "400", "500",
              "--resolutions", "600",     "700",        "800"});
  ASSERT_EQ(projections.pinholes.size(), 2U);
  EXPECT_EQ(projections.pinholes[0].height, 300);
  EXPECT_EQ(projections.pinholes[0].width, 600);
  EXPECT_NEAR(projections.pinholes[0].focal_px.y(), 299.0 / 2.0 / std::tan(35.0 * kDegree), 1e-9);
  EXPECT_TRUE(projections.pinholes[1].R_cam_view.col(2).isApprox(-Eigen::Vector3d::UnitX(), 1e-12));
  ASSERT_TRUE(projections.rectified);
  EXPECT_EQ(projections.rectified->height, 400);
  EXPECT_EQ(projections.rectified->width, 700);
}

TEST(ProjectionFlags, MakeACubeOfFiveFaces) {
  EXPECT_EQ(parsed({"--projections", "cube"}).pinholes.size(), 5U);
  const pipeline::Projections larger = parsed({"--projections", "cube", "--fovs", "100", "100"});
  EXPECT_LT(larger.pinholes[4].focal_px.x(), 999.0 / 2.0);
}

TEST(ProjectionFlags, GivenSeveralTimesAddUp) {
  const pipeline::Projections projections = parsed({"--projections", "cube", "--projections", "homography"});
  EXPECT_EQ(projections.pinholes.size(), 5U);
  EXPECT_TRUE(projections.rectified);
}

TEST(ProjectionFlags, NeedTwoRowsOfOneLength) {
  const Words two = {"--projections", "pinhole", "pinhole"};
  const auto with = [&two](const Words& rows) {
    Words words = two;
    words.insert(words.end(), rows.begin(), rows.end());
    return words;
  };
  EXPECT_EQ(parsed(with({"--poses", "0", "90", "--poses", "90", "0"})).pinholes.size(), 2U);
  EXPECT_EQ(parsed(with({"--poses", "0", "90", "90", "0"})).pinholes.size(), 2U);
  expectUsageError(with({"--poses", "0", "--poses", "90", "0", "0"}), "its rows have 1, 3 values");
  expectUsageError(with({"--fovs", "90", "--fovs", "90", "--fovs", "90", "--fovs", "90"}),
                   "its rows have 1, 1, 1, 1 values");
}

TEST(ProjectionFlags, NameWhatIsWrong) {
  expectUsageError({"--projections", "fisheye"}, "fisheye");
  expectUsageError({"--fovs", "90", "90"}, "--projections, which is missing");
  expectUsageError({"--projections", "pinhole", "pinhole", "--fovs", "90", "--fovs", "90"}, "--fovs needs two rows");
  expectUsageError({"--projections", "pinhole", "--fovs", "180", "90"}, "--fovs takes angles");
  expectUsageError({"--projections", "pinhole", "--resolutions", "10", "100"}, "--resolutions takes");
  expectUsageError({"--projections", "pinhole", "--resolutions", "100.5", "100"}, "whole pixels");
}

}  // namespace
}  // namespace tartan_calib::apps
