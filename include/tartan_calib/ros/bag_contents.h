#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

namespace tartan_calib::ros {

/// What a message says about an image before its pixels begin.
struct ImageRecord {
  std::int64_t received_ns = 0;  ///< when it was recorded
  std::int64_t stamp_ns = 0;     ///< of its header; 0 where that was never set
  int width = 0;                 ///< 0 in a sensor_msgs/CompressedImage, where only the data say it
  int height = 0;
  std::string encoding;  ///< `format` of a sensor_msgs/CompressedImage
};

struct ImageTopic {
  std::string topic;
  std::string type;
  std::vector<ImageRecord> images;  ///< as received
  std::size_t num_unreadable = 0;   ///< messages of which not even this can be read
  bool is_supported = true;         ///< openBag reads this encoding
  /// Image of an index in CV_8UC1. Throws InputError. For one thread at a time.
  std::function<cv::Mat(std::size_t)> load;
};

struct OtherTopic {
  std::string topic;
  std::string type;
  std::size_t num_messages = 0;
  std::int64_t first_ns = 0;  ///< received
  std::int64_t last_ns = 0;
};

struct BagContents {
  std::vector<ImageTopic> image_topics;  ///< by name, cam2 before cam10
  std::vector<OtherTopic> other_topics;  ///< by name
};

/// Lists a ROS 1 bag by its index and the first bytes of its images: no pixels are read until `load` asks for some. Only
/// chunks that are compressed have to be read through. Throws InputError where the file is no bag.
BagContents listBag(const std::string& path);

}  // namespace tartan_calib::ros
