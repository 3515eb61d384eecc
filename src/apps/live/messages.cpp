#include "live/messages.h"

#include <sensor_msgs/image_encodings.h>

namespace tartan_calib::apps {

sensor_msgs::Image colourMessage(const cv::Mat& bgr, std::int64_t stamp_ns, const std::string& frame_id) {
  sensor_msgs::Image message;
  message.header.stamp.fromNSec(static_cast<std::uint64_t>(stamp_ns));
  message.header.frame_id = frame_id;
  message.width = static_cast<std::uint32_t>(bgr.cols);
  message.height = static_cast<std::uint32_t>(bgr.rows);
  message.step = static_cast<std::uint32_t>(bgr.elemSize()) * message.width;
  message.encoding = sensor_msgs::image_encodings::BGR8;
  message.data.reserve(message.step * message.height);
  for (int row = 0; row < bgr.rows; ++row) {
    message.data.insert(message.data.end(), bgr.ptr(row), bgr.ptr(row) + message.step);
  }
  return message;
}

std_msgs::String textMessage(const std::string& text) {
  std_msgs::String message;
  message.data = text;
  return message;
}

void addValue(diagnostic_msgs::DiagnosticStatus& status, const std::string& key, const std::string& value) {
  diagnostic_msgs::KeyValue pair;
  pair.key = key;
  pair.value = value;
  status.values.push_back(pair);
}

void worsen(diagnostic_msgs::DiagnosticStatus& status, std::int8_t level, const std::string& message) {
  if (level > status.level || status.message.empty()) {
    status.level = level;
    status.message = message;
  }
}

}  // namespace tartan_calib::apps
