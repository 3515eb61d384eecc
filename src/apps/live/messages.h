#pragma once

#include <diagnostic_msgs/DiagnosticStatus.h>
#include <sensor_msgs/Image.h>
#include <std_msgs/String.h>

#include <cstdint>
#include <opencv2/core.hpp>
#include <string>

namespace tartan_calib::apps {

/// sensor_msgs/Image of encoding bgr8 from CV_8UC3.
sensor_msgs::Image colourMessage(const cv::Mat& bgr, std::int64_t stamp_ns, const std::string& frame_id);

std_msgs::String textMessage(const std::string& text);

/// Adds a key and its value.
void addValue(diagnostic_msgs::DiagnosticStatus& status, const std::string& key, const std::string& value);

/// Makes the status at least that bad, with that message; of several messages the worst one stays.
void worsen(diagnostic_msgs::DiagnosticStatus& status, std::int8_t level, const std::string& message);

}  // namespace tartan_calib::apps
