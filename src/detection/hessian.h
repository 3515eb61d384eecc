#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <vector>

namespace tartan_calib::detection {

/// Image after a 5x5 binomial filter (sigma 1 px), CV_16SC1, in 1/32 grey levels.
constexpr int kSmoothedUnitsPerGrey = 32;
cv::Mat smoothBinomial(const cv::Mat& gray);

/// A local maximum of -det(Hessian) at pixel (x, y).
struct SaddlePeak {
  std::int32_t response = 0;  ///< in squared units of the smoothed image
  int x = 0;
  int y = 0;
};

/// 3x3 maxima of -det(Hessian) above `min_response` at least `margin_px` away from the border, in scan order.
std::vector<SaddlePeak> findSaddlePeaks(const cv::Mat& smoothed, std::int32_t min_response, int margin_px);

}  // namespace tartan_calib::detection
