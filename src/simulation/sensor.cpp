#include "tartan_calib/simulation/sensor.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace tartan_calib::simulation {

void applyPsf(cv::Mat& grey, double sigma_px) {
  constexpr double kRadiusInSigmas = 4.5;  // cuts less than 1e-5 of the weight
  constexpr int kSpareWeights = 2;         // for the heavier tail of a narrow kernel
  if (sigma_px <= 0.0) {
    return;
  }
  const int radius = static_cast<int>(std::ceil(kRadiusInSigmas * sigma_px)) + kSpareWeights;
  cv::Mat1d kernel(2 * radius + 1, 1);
  for (int i = -radius; i <= radius; ++i) {
    const double variance_px2 = sigma_px * sigma_px;
    kernel(i + radius, 0) = std::exp(-variance_px2) * std::cyl_bessel_i(std::abs(i), variance_px2);
  }
  kernel /= cv::sum(kernel)[0];
  cv::sepFilter2D(grey, grey, -1, kernel, kernel, cv::Point(-1, -1), 0.0, cv::BORDER_REPLICATE);
}

double pixelVariance(double grey, const SensorOptions& options) {
  constexpr double kRounding = 1.0 / 12.0;
  return options.read_noise_grey * options.read_noise_grey + options.shot_noise_grey * std::max(0.0, grey) + kRounding;
}

cv::Mat expose(const cv::Mat1f& grey, const SensorOptions& options, std::uint64_t seed) {
  cv::Mat1f noisy = grey.clone();
  const double read_variance = options.read_noise_grey * options.read_noise_grey;
  if (read_variance > 0.0 || options.shot_noise_grey > 0.0) {
    cv::Mat1f unit(grey.size());
    cv::RNG rng(seed);
    rng.fill(unit, cv::RNG::NORMAL, 0.0, 1.0);
    cv::Mat sigma = cv::max(grey, 0.0F) * options.shot_noise_grey + read_variance;
    cv::sqrt(sigma, sigma);
    noisy += unit.mul(sigma);
  }
  cv::Mat image;
  noisy.convertTo(image, CV_8U);
  return image;
}

}  // namespace tartan_calib::simulation
