#include "tartan_calib/detection/saddle.h"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/imgproc.hpp>

namespace tartan_calib::detection {
namespace {

constexpr double kPi = 3.14159265358979323846;

struct Junction {
  Eigen::Vector2d px;
  double first_edge_rad;   ///< the dark wedge reaches from here
  double second_edge_rad;  ///< to here
};

/// Two lines that cross in an otherwise empty 160 x 160 image, blurred with `sigma_px`.
cv::Mat render(const Junction& junction, double sigma_px) {
  constexpr int kSize_px = 160;
  constexpr int kSubsamples = 8;
  cv::Mat image(kSize_px, kSize_px, CV_32FC1);
  const auto side = [&junction](double x, double y, double angle_rad) {
    return (x - junction.px.x()) * std::sin(angle_rad) - (y - junction.px.y()) * std::cos(angle_rad) < 0.0;
  };
  for (int y = 0; y < kSize_px; ++y) {
    for (int x = 0; x < kSize_px; ++x) {
      int num_light = 0;
      for (int k = 0; k < kSubsamples * kSubsamples; ++k) {
        const double u = x + (k % kSubsamples + 0.5) / kSubsamples - 0.5;
        const double v = y + (k / kSubsamples + 0.5) / kSubsamples - 0.5;
        num_light += side(u, v, junction.first_edge_rad) == side(u, v, junction.second_edge_rad) ? 1 : 0;
      }
      image.at<float>(y, x) = 40.0F + 160.0F * static_cast<float>(num_light) / (kSubsamples * kSubsamples);
    }
  }
  cv::GaussianBlur(image, image, {}, sigma_px);
  cv::Mat gray;
  image.convertTo(gray, CV_8U);
  return gray;
}

double lineDifference(double a_rad, double b_rad) { return std::abs(std::remainder(a_rad - b_rad, kPi)); }

class FindSaddles : public testing::TestWithParam<double> {};

TEST_P(FindSaddles, locatesAJunctionItsPolarityAndItsEdges) {
  for (const Junction& junction : {Junction{{80.3, 79.6}, 0.2, 1.8}, Junction{{77.0, 83.5}, 1.7, 2.9}}) {
    const auto saddles = findSaddles(render(junction, GetParam()));
    ASSERT_EQ(saddles.size(), 1U);
    const Saddle& saddle = saddles.front();
    EXPECT_LT((saddle.px - junction.px).norm(), 0.15);
    EXPECT_LT(lineDifference(saddle.arm_rad[0], junction.first_edge_rad), 0.16);
    EXPECT_LT(lineDifference(saddle.arm_rad[1], junction.second_edge_rad), 0.16);
    EXPECT_LT(lineDifference(saddle.arm_rad[2], junction.first_edge_rad), 0.16);
    EXPECT_LT(lineDifference(saddle.arm_rad[3], junction.second_edge_rad), 0.16);
    EXPECT_LT(saddle.contrast, 165.0);
    EXPECT_GT(saddle.contrast, 80.0);
  }
}

INSTANTIATE_TEST_SUITE_P(Blur, FindSaddles, testing::Values(0.5, 1.0, 2.0, 3.5));

TEST(FindSaddlesInNothing, findsNothing) {
  EXPECT_TRUE(findSaddles(cv::Mat(200, 300, CV_8UC1, cv::Scalar(90))).empty());
  EXPECT_TRUE(findSaddles(cv::Mat(3, 300, CV_8UC1, cv::Scalar(90))).empty());
  EXPECT_TRUE(findSaddles(cv::Mat(0, 0, CV_8UC1)).empty());
}

TEST(FindSaddlesOnACorner, isNotFooledByASquare) {
  cv::Mat image(160, 160, CV_8UC1, cv::Scalar(200));
  cv::rectangle(image, {50, 60}, {110, 100}, cv::Scalar(30), cv::FILLED);
  cv::GaussianBlur(image, image, {}, 0.8);
  EXPECT_TRUE(findSaddles(image).empty());
}

TEST(FindSaddlesAtTheBorder, staysInsideTheImage) {
  for (const double x : {3.0, 4.5, 155.0, 158.0}) {
    for (const double y : {2.0, 80.0, 156.0}) {
      for (const Saddle& saddle : findSaddles(render({{x, y}, 0.1, 1.5}, 0.7))) {
        EXPECT_LT((saddle.px - Eigen::Vector2d(x, y)).norm(), 0.3);
      }
    }
  }
}

}  // namespace
}  // namespace tartan_calib::detection
