#pragma once

#include <gtest/gtest.h>
#include <rosbag/bag.h>
#include <sensor_msgs/Image.h>
#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "tartan_calib/error.h"
#include "tartan_calib/ros/bag_reader.h"
#include "tartan_calib/ros/bag_writer.h"

namespace tartan_calib::ros {

constexpr int kWidth = 24;
constexpr int kHeight = 16;
constexpr std::int64_t kStart = 1'600'000'000'000'000'000;
constexpr std::int64_t kMs = 1'000'000;
inline const std::string kTopic = "/cam0/image_raw";

/// A bag that is removed with the test.
class BagFile {
 public:
  BagFile() : path_(std::filesystem::temp_directory_path() / (testName() + ".bag")) {}
  ~BagFile() { std::filesystem::remove(path_); }
  std::string path() const { return path_.string(); }

 private:
  static std::string testName() {
    const auto* info = ::testing::UnitTest::GetInstance()->current_test_info();
    std::string name = std::string(info->test_suite_name()) + "." + info->name() + "." + std::to_string(::getpid());
    std::replace(name.begin(), name.end(), '/', '_');
    return name;
  }
  std::filesystem::path path_;
};

inline cv::Mat grayRamp() {
  cv::Mat gray(kHeight, kWidth, CV_8UC1);
  for (int row = 0; row < kHeight; ++row) {
    for (int col = 0; col < kWidth; ++col) {
      gray.at<std::uint8_t>(row, col) = static_cast<std::uint8_t>(5 * row + 7 * col);
    }
  }
  return gray;
}

inline sensor_msgs::Image message(const cv::Mat& pixels, const std::string& encoding, std::int64_t stamp_ns = kStart) {
  sensor_msgs::Image image;
  image.header.stamp.fromNSec(static_cast<std::uint64_t>(stamp_ns));
  image.width = static_cast<std::uint32_t>(pixels.cols);
  image.height = static_cast<std::uint32_t>(pixels.rows);
  image.encoding = encoding;
  image.step = static_cast<std::uint32_t>(pixels.step[0]);
  image.data.assign(pixels.datastart, pixels.dataend);
  return image;
}

template <class Message>
void store(const std::string& path, const std::vector<Message>& messages) {
  rosbag::Bag bag(path, rosbag::bagmode::Write);
  std::int64_t received_ns = kStart + 5 * kMs;
  for (const Message& each : messages) {
    ::ros::Time received;
    received.fromNSec(static_cast<std::uint64_t>(received_ns += kMs));
    bag.write(kTopic, received, each);
  }
}

inline std::vector<pipeline::StampedImage> readAll(const std::string& path, const io::RecordingOptions& options = {}) {
  std::vector<pipeline::StampedImage> images;
  const pipeline::ImageSource source = openBag(path, {kTopic}, options).front().open();
  while (auto image = source()) {
    images.push_back(*image);
  }
  return images;
}

inline std::string errorOf(const std::function<void()>& action) {
  try {
    action();
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

inline double largestDifference(const cv::Mat& a, const cv::Mat& b) { return cv::norm(a, b, cv::NORM_INF); }

}  // namespace tartan_calib::ros
