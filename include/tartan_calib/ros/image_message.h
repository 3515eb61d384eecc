#pragma once

#include <sensor_msgs/CompressedImage.h>
#include <sensor_msgs/Image.h>

#include <opencv2/core.hpp>
#include <string>

namespace tartan_calib::ros {

/// Whether images of this sensor_msgs/Image encoding can be read.
bool isSupportedEncoding(const std::string& encoding);

/// Whether this sensor_msgs/CompressedImage format can be read. Drivers write it freely: "jpeg", "rgb8; jpeg compressed
/// bgr8".
bool isSupportedFormat(const std::string& format);

/// Names for an error message.
std::string supportedEncodings();
std::string supportedFormats();

/// CV_8UC1, or CV_16UC1 for 16-bit encodings, in the machine's byte order. Throws InputError where size, step and data
/// contradict each other or the encoding is not supported.
cv::Mat grayImage(const sensor_msgs::Image& message);
cv::Mat grayImage(const sensor_msgs::CompressedImage& message);

}  // namespace tartan_calib::ros
