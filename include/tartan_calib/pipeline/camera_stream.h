#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <opencv2/core.hpp>
#include <optional>
#include <string>

namespace tartan_calib::pipeline {

/// An image that is decoded only when asked for, so that decoding runs on the worker threads.
struct StampedImage {
  std::int64_t stamp_ns = 0;
  std::function<cv::Mat()>
      load;  ///< CV_8UC1; may be called once, from any thread; throws InputError when it cannot be decoded
};

/// Yields images by increasing stamp until it returns nothing. Not thread-safe.
using ImageSource = std::function<std::optional<StampedImage>()>;

/// The images of one camera, wherever they are stored.
struct CameraStream {
  std::string topic;
  std::size_t num_images = 0;         ///< after selection by time and rate
  std::function<ImageSource()> open;  ///< starts from the first image; may be called again for another pass
};

}  // namespace tartan_calib::pipeline
