#pragma once

#include <cstdint>
#include <opencv2/core.hpp>

namespace tartan_calib::simulation {

/// What happens to light between the lens and the file. Grey levels are those of 8 bits. The noise is that of a machine
/// vision camera whose pixels hold 10 000 electrons.
struct SensorOptions {
  double psf_sigma_px = 0.6;       ///< Gaussian, beside the pixel's own square; at most 20
  double read_noise_grey = 1.0;    ///< standard deviation in the dark
  double shot_noise_grey = 0.025;  ///< variance per grey level of signal
};

/// Blurs in place, any number of channels, with Lindeberg's discrete Gaussian, whose variance is sigma^2 however narrow it
/// is. Each pixel is an exact area average, so a symmetric sum of shifted ones is the image under a symmetric point spread
/// function: nothing moves.
void applyPsf(cv::Mat& grey, double sigma_px);

/// Variance of a pixel of the file whose light is `grey`, rounding included.
double pixelVariance(double grey, const SensorOptions& options);

/// Adds noise, cuts at 0 and 255 and rounds to CV_8UC1.
cv::Mat expose(const cv::Mat1f& grey, const SensorOptions& options, std::uint64_t seed);

}  // namespace tartan_calib::simulation
