#include "tartan_calib/simulation/sensor.h"

#include <gtest/gtest.h>

#include <cmath>

namespace tartan_calib::simulation {
namespace {

TEST(Sensor, hasTheReadAndShotNoiseAskedFor) {
  const SensorOptions options{0.0, 2.0, 0.05};
  for (const float grey : {20.0F, 200.0F}) {
    const cv::Mat image = expose(cv::Mat1f(500, 500, grey), options, 11);
    cv::Scalar mean;
    cv::Scalar sigma;
    cv::meanStdDev(image, mean, sigma);
    const double expected = 4.0 + 0.05 * static_cast<double>(grey) + 1.0 / 12.0;
    EXPECT_NEAR(mean[0], static_cast<double>(grey), 0.03);
    EXPECT_NEAR(sigma[0] * sigma[0], expected, 0.015 * expected) << "5 sigma of 250 000 samples";
    EXPECT_NEAR(pixelVariance(static_cast<double>(grey), options), expected, 1e-6);
  }
}

TEST(Sensor, cutsAtBlackAndWhiteAndRounds) {
  cv::Mat1f grey(1, 4);
  grey << -20.0F, 300.0F, 99.4F, 99.6F;
  const cv::Mat image = expose(grey, {0.0, 0.0, 0.0}, 1);
  const unsigned char expected[] = {0, 255, 99, 100};
  for (int col = 0; col < 4; ++col) {
    EXPECT_EQ(image.at<unsigned char>(0, col), expected[col]);
  }
}

TEST(Sensor, spreadsAPointByTheSigmaAskedFor) {
  for (const double sigma_px : {0.5, 0.8, 2.0}) {
    cv::Mat grey(41, 41, CV_32F, cv::Scalar(0.0));
    grey.at<float>(20, 20) = 1.0F;
    applyPsf(grey, sigma_px);
    double sum = 0.0;
    double second_moment_px2 = 0.0;
    for (int row = 0; row < 41; ++row) {
      for (int col = 0; col < 41; ++col) {
        sum += static_cast<double>(grey.at<float>(row, col));
        second_moment_px2 += static_cast<double>(grey.at<float>(row, col)) * (col - 20) * (col - 20);
        EXPECT_EQ(grey.at<float>(row, col), grey.at<float>(40 - row, 40 - col)) << "symmetric";
      }
    }
    EXPECT_NEAR(sum, 1.0, 1e-5);
    EXPECT_NEAR(second_moment_px2, sigma_px * sigma_px, 1e-3 * sigma_px * sigma_px) << sigma_px;
  }
}

}  // namespace
}  // namespace tartan_calib::simulation
