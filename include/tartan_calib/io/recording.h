#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <opencv2/core.hpp>
#include <optional>
#include <string>
#include <vector>

namespace tartan_calib::io {

/// Seconds after the first image of a topic; both ends belong to it.
struct TimeWindow {
  double from_s = 0.0;
  double to_s = 0.0;
};

/// Which images of a recording are wanted, whatever it is stored in.
struct RecordingOptions {
  std::optional<TimeWindow> window;
  std::optional<double> max_rate_hz;               ///< of all topics together: cameras of a rig stay together
  std::function<void(const std::string&)> notice;  ///< told what a user should know of; may be empty
};

/// Throws InputError for a window that is empty and a rate that is not positive.
void checkOptions(const RecordingOptions& options);

/// When the images of a topic were taken.
struct TopicStamps {
  std::string topic;
  std::vector<std::int64_t> stamps_ns;  ///< sorted
};

/// Indices of the wanted images of every topic. Where there is a largest rate, one is taken whenever some topic has an image
/// at least 1 / rate after the last time: of every topic the image nearest to that, if it is less than 1 / rate away. Throws
/// InputError where a topic has none.
std::vector<std::vector<std::size_t>> selectImages(const std::vector<TopicStamps>& topics, const RecordingOptions& options);

/// Calls options.notice where there is one.
void notify(const RecordingOptions& options, const std::string& message);

/// Tells how 16-bit images of a topic are reduced to 8 bits, judged by `gray`, one of them; silent for 8-bit images.
void notifyOfReduction(const RecordingOptions& options, const std::string& topic, const cv::Mat& gray);

}  // namespace tartan_calib::io
