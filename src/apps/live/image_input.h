#pragma once

#include <ros/node_handle.h>

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <mutex>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "tartan_calib/guidance/newest_view.h"

namespace tartan_calib::apps {

/// An image that arrived, not decoded yet.
struct ArrivedImage {
  int camera_index = 0;
  std::int64_t stamp_ns = 0;
  std::function<cv::Mat()> decode;  ///< CV_8UC1; throws InputError
};

struct InputCounts {
  std::size_t received = 0;
  std::size_t dropped = 0;  ///< never looked at, for newer ones
};

/// Subscribes to the topics of some cameras and yields the newest images that belong together. Topics that end with
/// `/compressed` carry sensor_msgs/CompressedImage, the others sensor_msgs/Image. Callbacks only store pointers.
class ImageInput {
 public:
  ImageInput(::ros::NodeHandle node, const std::vector<std::string>& topics, const guidance::NewestViewOptions& options);

  /// Waits no longer than that; empty where nothing came.
  std::vector<ArrivedImage> take(std::chrono::milliseconds timeout);

  InputCounts counts(int camera_index);

 private:
  using Decode = std::function<cv::Mat()>;

  template <class Message>
  void subscribe(::ros::NodeHandle& node, const std::string& topic, int camera_index);
  void add(int camera_index, std::int64_t stamp_ns, Decode decode);

  std::mutex mutex_;
  std::condition_variable arrived_;
  guidance::NewestView<Decode> waiting_;
  std::vector<std::size_t> num_received_;
  std::vector<::ros::Subscriber> subscribers_;
};

}  // namespace tartan_calib::apps
