#pragma once

#include <cstdint>
#include <opencv2/core.hpp>

namespace tartan_calib::detection {

/// Grey value between pixels of an 8-bit image. The caller keeps (x, y) inside [0, cols - 1) x [0, rows - 1).
inline float sampleBilinear(const cv::Mat& image, double x, double y) {
  const int column = static_cast<int>(x);
  const int row = static_cast<int>(y);
  const auto fx = static_cast<float>(x - column);
  const auto fy = static_cast<float>(y - row);
  const std::uint8_t* top = image.ptr<std::uint8_t>(row) + column;
  const std::uint8_t* bottom = image.ptr<std::uint8_t>(row + 1) + column;
  const auto lerp = [](float from, float to, float share) { return from + share * (to - from); };
  return lerp(lerp(top[0], top[1], fx), lerp(bottom[0], bottom[1], fx), fy);
}

/// True where a bilinear sample at (x, y) exists.
inline bool canSample(const cv::Mat& image, double x, double y) {
  return x >= 0.0 && y >= 0.0 && x < image.cols - 1 && y < image.rows - 1;
}

}  // namespace tartan_calib::detection
