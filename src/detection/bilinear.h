#pragma once

#include <opencv2/core.hpp>

namespace tartan_calib::detection {

/// Grey value between pixels. The caller keeps (x, y) inside [0, cols - 1) x [0, rows - 1).
template <typename T>
inline double sampleBilinear(const cv::Mat& image, double x, double y) {
  const int column = static_cast<int>(x);
  const int row = static_cast<int>(y);
  const double fx = x - column;
  const double fy = y - row;
  const T* top = image.ptr<T>(row) + column;
  const T* bottom = image.ptr<T>(row + 1) + column;
  return (1.0 - fy) * ((1.0 - fx) * top[0] + fx * top[1]) + fy * ((1.0 - fx) * bottom[0] + fx * bottom[1]);
}

/// True where a bilinear sample at (x, y) exists.
inline bool canSample(const cv::Mat& image, double x, double y) {
  return x >= 0.0 && y >= 0.0 && x < image.cols - 1 && y < image.rows - 1;
}

}  // namespace tartan_calib::detection
