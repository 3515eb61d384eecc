#include "make_bag/make_bag.h"

#include <gtest/gtest.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <sensor_msgs/Imu.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <opencv2/imgcodecs.hpp>

#include "tartan_calib/error.h"
#include "tartan_calib/ros/bag_reader.h"

namespace tartan_calib::apps {
namespace {

namespace fs = std::filesystem;

class MakeBag : public ::testing::Test {
 protected:
  MakeBag() : folder(fs::temp_directory_path() / ("make_bag_test." + std::to_string(::getpid()))) {
    fs::create_directories(folder / "cam0");
    fs::create_directories(folder / "cam1");
  }
  ~MakeBag() override { fs::remove_all(folder); }

  void writeImage(const std::string& name, int value) {
    cv::imwrite((folder / name).string(), cv::Mat(6, 8, CV_8UC1, cv::Scalar(value)));
  }
  void writeText(const std::string& name, const std::string& text) { std::ofstream(folder / name) << text; }
  static constexpr std::size_t kNumPixels = 48;  // of writeImage
  static std::string pixels(int value) { return std::string(kNumPixels, static_cast<char>(value)); }
  static std::string doubleBytes(double value) { return std::string(reinterpret_cast<const char*>(&value), sizeof(value)); }
  std::string bag() const { return (folder / "out.bag").string(); }

  fs::path folder;
  std::vector<std::string> notices;
};

TEST_F(MakeBag, StoresImagesAndImuByIncreasingStamp) {
  writeImage("cam0/1000.png", 10);
  writeImage("cam1/2000.png", 20);
  writeImage("cam0/3000.png", 30);
  writeText("imu0.csv", "#stamp,wx,wy,wz,ax,ay,az\n2500,0.1,0.2,0.3,1,2,9.8\n500, 0, 0, 0, 0, 0, 9.81\n");
  const BagContents contents = makeBag(folder.string(), bag(), {});
  EXPECT_EQ(contents.num_images, 3U);
  EXPECT_EQ(contents.num_imu_samples, 2U);

  std::ifstream file(bag(), std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  std::vector<std::size_t> positions;
  for (const std::string& content : {doubleBytes(9.81), pixels(10), pixels(20), doubleBytes(9.8), pixels(30)}) {
    positions.push_back(bytes.find(content));
    EXPECT_NE(positions.back(), std::string::npos);
  }
  EXPECT_TRUE(std::is_sorted(positions.begin(), positions.end()));
}

TEST_F(MakeBag, KeepsStampsPixelsAndRates) {
  constexpr std::int64_t kStamp = 1606153907495166540;
  writeImage("cam0/" + std::to_string(kStamp) + ".png", 77);
  writeText("imu0.csv", std::to_string(kStamp) + ",0.1,0.2,0.3,1,2,9.8\n");
  fs::remove(folder / "cam1");
  makeBag(folder.string(), bag(), {});
  const auto image = ros::openBag(bag(), {"/cam0/image_raw"}, {}).front().open()();
  EXPECT_EQ(image->stamp_ns, kStamp);
  EXPECT_EQ(image->load().at<std::uint8_t>(5, 7), 77);

  rosbag::Bag stored(bag());
  rosbag::View view(stored, rosbag::TopicQuery("/imu0"));
  const auto imu = view.begin()->instantiate<sensor_msgs::Imu>();
  EXPECT_EQ(static_cast<std::int64_t>(imu->header.stamp.toNSec()), kStamp);
  EXPECT_EQ(imu->angular_velocity.y, 0.2);
  EXPECT_EQ(imu->linear_acceleration.z, 9.8);
}

TEST_F(MakeBag, LeavesOutBrokenImagesAndNamesThem) {
  writeImage("cam0/1000.png", 10);
  writeText("cam0/2000.png", "not an image");
  const BagContents contents = makeBag(folder.string(), bag(), [this](const std::string& text) { notices.push_back(text); });
  EXPECT_EQ(contents.num_images, 1U);
  EXPECT_EQ(contents.num_skipped_images, 1U);
  ASSERT_EQ(notices.size(), 1U);
  EXPECT_NE(notices.front().find("2000.png"), std::string::npos);
}

TEST_F(MakeBag, NamesFileAndLineOfABrokenImuRow) {
  writeImage("cam0/1000.png", 10);
  writeText("imu0.csv", "500,0,0,0,0,0,9.81\n600,0,0\n");
  try {
    makeBag(folder.string(), bag(), {});
    FAIL() << "a short row was accepted";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("imu0.csv, line 2"), std::string::npos) << error.what();
  }
  EXPECT_FALSE(fs::exists(bag()));
}

}  // namespace
}  // namespace tartan_calib::apps
