#include "tartan_calib/ros/bag_contents.h"

#include <gtest/gtest.h>
#include <sensor_msgs/CompressedImage.h>
#include <sensor_msgs/Imu.h>

#include <filesystem>
#include <fstream>
#include <opencv2/imgcodecs.hpp>

#include "ros/bag_file.h"

namespace tartan_calib::ros {
namespace {

::ros::Time timeAt(std::int64_t time_ms) {
  return ::ros::Time().fromNSec(static_cast<std::uint64_t>(kStart + time_ms * kMs));
}

sensor_msgs::CompressedImage compressed(std::int64_t stamp_ns) {
  sensor_msgs::CompressedImage image;
  image.header.stamp.fromNSec(static_cast<std::uint64_t>(stamp_ns));
  image.format = "mono8; png compressed";
  cv::imencode(".png", grayRamp(), image.data);
  return image;
}

/// Two cameras, one of which changes its size and forgets a stamp, a third that compresses, and an IMU between them.
void storeRig(const std::string& path, rosbag::CompressionType compression) {
  rosbag::Bag bag(path, rosbag::bagmode::Write);
  bag.setCompression(compression);
  bag.setChunkThreshold(1000);  // many chunks
  for (int i = 0; i < 6; ++i) {
    const std::int64_t stamp_ns = i == 4 ? 0 : kStart + 100 * i * kMs;
    const cv::Mat gray = i == 5 ? cv::Mat(grayRamp().rowRange(0, 8)) : grayRamp();
    bag.write("/cam10/image_raw", timeAt(100 * i + 7), message(gray, "mono8", stamp_ns));
    bag.write("/cam2/image_raw", timeAt(100 * i + 9), message(grayRamp() / (i + 1), "mono8", kStart + 100 * i * kMs));
    bag.write("/cam3/image/compressed", timeAt(100 * i), compressed(kStart + 100 * i * kMs));
    sensor_msgs::Imu imu;
    bag.write("/imu0", timeAt(100 * i + 50), imu);
  }
}

void expectRig(const BagContents& contents) {
  ASSERT_EQ(contents.image_topics.size(), 3U);
  EXPECT_EQ(contents.image_topics[0].topic, "/cam2/image_raw");
  const ImageTopic& camera = contents.image_topics[1];
  EXPECT_EQ(camera.topic, "/cam10/image_raw");
  EXPECT_EQ(camera.type, "sensor_msgs/Image");
  EXPECT_TRUE(camera.is_supported);
  ASSERT_EQ(camera.images.size(), 6U);
  for (std::size_t i = 0; i < 6; ++i) {
    const std::int64_t time_ns = kStart + 100 * static_cast<std::int64_t>(i) * kMs;
    EXPECT_EQ(camera.images[i].received_ns, time_ns + 7 * kMs);
    EXPECT_EQ(camera.images[i].stamp_ns, i == 4 ? 0 : time_ns);
    EXPECT_EQ(camera.images[i].width, kWidth);
    EXPECT_EQ(camera.images[i].height, i == 5 ? 8 : kHeight);
    EXPECT_EQ(camera.images[i].encoding, "mono8");
  }
  EXPECT_EQ(contents.image_topics[2].type, "sensor_msgs/CompressedImage");
  EXPECT_EQ(contents.image_topics[2].images.front().encoding, "mono8; png compressed");
  ASSERT_EQ(contents.other_topics.size(), 1U);
  EXPECT_EQ(contents.other_topics[0].topic, "/imu0");
  EXPECT_EQ(contents.other_topics[0].type, "sensor_msgs/Imu");
  EXPECT_EQ(contents.other_topics[0].num_messages, 6U);
  EXPECT_EQ(contents.other_topics[0].last_ns - contents.other_topics[0].first_ns, 500 * kMs);
}

TEST(BagContents, AreTheSameWhateverTheCompressionOfTheBag) {
  for (const auto compression : {rosbag::compression::Uncompressed, rosbag::compression::LZ4, rosbag::compression::BZ2}) {
    const BagFile bag;
    storeRig(bag.path(), compression);
    const BagContents contents = listBag(bag.path());
    expectRig(contents);
    for (std::size_t i = 0; i < 6; ++i) {
      EXPECT_EQ(largestDifference(contents.image_topics[0].load(i), grayRamp() / static_cast<double>(i + 1)), 0.0);
      EXPECT_EQ(largestDifference(contents.image_topics[2].load(i), grayRamp()), 0.0);
    }
  }
}

TEST(BagContents, NameWhatCannotBeUsed) {
  const BagFile bag;
  store<sensor_msgs::Image>(bag.path(), {message(cv::Mat(4, 4, CV_32FC1, cv::Scalar(0)), "32FC1")});
  const BagContents contents = listBag(bag.path());
  EXPECT_FALSE(contents.image_topics.front().is_supported);
  EXPECT_EQ(contents.image_topics.front().images.front().encoding, "32FC1");
  EXPECT_NE(errorOf([&] { contents.image_topics.front().load(0); }).find(kTopic), std::string::npos);
}

TEST(BagContents, CountMessagesThatCannotBeRead) {
  const BagFile bag;
  store<sensor_msgs::Image>(bag.path(), {message(grayRamp(), "mono8"), message(grayRamp(), "mono8")});
  std::string bytes;
  {
    std::ifstream file(bag.path(), std::ios::binary);
    bytes.assign(std::istreambuf_iterator<char>(file), {});
  }
  const std::string encoding("\5\0\0\0mono8", 9);
  bytes.replace(bytes.find(encoding), 4, "\xff\xff\xff\x7f");
  std::ofstream(bag.path(), std::ios::binary) << bytes;
  const ImageTopic topic = listBag(bag.path()).image_topics.front();
  EXPECT_EQ(topic.num_unreadable, 1U);
  EXPECT_EQ(topic.images.size(), 1U);
}

TEST(BagContents, OfABagThatEndsEarlyOrIsNoneAreAnError) {
  const BagFile bag;
  EXPECT_NE(errorOf([&] { listBag(bag.path()); }).find("does not exist"), std::string::npos);
  std::ofstream(bag.path()) << "text";
  EXPECT_NE(errorOf([&] { listBag(bag.path()); }).find("not a ROS 1 bag"), std::string::npos);
  std::filesystem::remove(bag.path());
  storeRig(bag.path(), rosbag::compression::Uncompressed);
  for (const double part : {0.3, 0.6, 0.9, 0.99}) {
    const auto size = static_cast<double>(std::filesystem::file_size(bag.path()));
    std::filesystem::resize_file(bag.path(), static_cast<std::uintmax_t>(part * size));
    EXPECT_NE(errorOf([&] { listBag(bag.path()); }).find("rosbag reindex"), std::string::npos) << part;
  }
}

}  // namespace
}  // namespace tartan_calib::ros
