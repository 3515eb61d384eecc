#include "tartan_calib/guidance/coverage_map.h"

#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>

namespace tartan_calib::guidance {
namespace {

constexpr int kWidth_px = 960;
constexpr int kHeight_px = 720;

/// A circle of light, as a fisheye lens has.
cv::Mat fisheyeImage() {
  cv::Mat gray(kHeight_px, kWidth_px, CV_8UC1, cv::Scalar(0));
  cv::circle(gray, {kWidth_px / 2, kHeight_px / 2}, kHeight_px / 2, cv::Scalar(100), cv::FILLED);
  return gray;
}

std::vector<observation::Corner> cornersEverywhere(double from_x_px, double to_x_px) {
  std::vector<observation::Corner> corners;
  for (double x_px = from_x_px; x_px < to_x_px; x_px += 20.0) {
    for (double y_px = 10.0; y_px < kHeight_px; y_px += 20.0) {
      corners.push_back({0, {x_px, y_px}});
    }
  }
  return corners;
}

TEST(CoverageMap, CountsEveryCornerOnce) {
  CoverageMap map(kWidth_px, kHeight_px);
  const auto corners = cornersEverywhere(0.0, kWidth_px);
  map.addCorners(corners);
  EXPECT_EQ(cv::sum(map.counts())[0], static_cast<double>(corners.size()));
  map.clearCorners();
  EXPECT_EQ(cv::sum(map.counts())[0], 0.0);
}

TEST(CoverageMap, WhatTheLensLeavesDarkIsNotMissed) {
  CoverageMap map(kWidth_px, kHeight_px);
  map.addImage(fisheyeImage());
  EXPECT_TRUE(map.isLit({480.0, 360.0}));
  EXPECT_FALSE(map.isLit({5.0, 5.0}));
  EXPECT_FALSE(map.isLit({-1000.0, 360.0}));
  map.addCorners(cornersEverywhere(0.0, kWidth_px));
  EXPECT_TRUE(map.emptyRegions().empty());
}

TEST(CoverageMap, NamesTheHalfWithoutCorners) {
  CoverageMap map(kWidth_px, kHeight_px);
  map.addImage(cv::Mat(kHeight_px, kWidth_px, CV_8UC1, cv::Scalar(100)));
  map.addCorners(cornersEverywhere(0.0, 0.66 * kWidth_px));
  ASSERT_EQ(map.litRegions().size(), 9u);
  ASSERT_EQ(map.emptyRegions().size(), 3u);
  for (const Region& region : map.emptyRegions()) {
    EXPECT_EQ(region.col, 2);
  }
}

TEST(CoverageMap, WhatWasLitOnceStaysLit) {
  CoverageMap map(kWidth_px, kHeight_px);
  map.addImage(fisheyeImage());
  map.addImage(cv::Mat(kHeight_px, kWidth_px, CV_8UC1, cv::Scalar(0)));
  EXPECT_TRUE(map.isLit({480.0, 360.0}));
}

}  // namespace
}  // namespace tartan_calib::guidance
