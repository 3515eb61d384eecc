#include <gtest/gtest.h>
#include <sensor_msgs/CompressedImage.h>

#include <filesystem>
#include <fstream>
#include <iterator>

#include "ros/bag_file.h"
#include "tartan_calib/ros/bag_contents.h"

namespace tartan_calib::ros {
namespace {

std::vector<std::int64_t> readStamps(const std::string& path, const io::RecordingOptions& options) {
  std::vector<std::int64_t> stamps_ms;
  for (const auto& image : readAll(path, options)) {
    stamps_ms.push_back((image.stamp_ns - kStart) / kMs);
  }
  return stamps_ms;
}

TEST(BagReader, OrdersImagesByHeaderStamp) {
  const BagFile bag;
  store<sensor_msgs::Image>(bag.path(), {message(grayRamp(), "mono8", kStart + 30 * kMs), message(grayRamp(), "mono8"),
                                         message(grayRamp(), "mono8", kStart + 10 * kMs)});
  EXPECT_EQ(readStamps(bag.path(), {}), (std::vector<std::int64_t>{0, 10, 30}));
}

TEST(BagReader, UsesTheTimeOfReceiptWhereNoStampWasSet) {
  const BagFile bag;
  store<sensor_msgs::Image>(bag.path(), {message(grayRamp(), "mono8", 0), message(grayRamp(), "mono8", 0)});
  EXPECT_EQ(readStamps(bag.path(), {}), (std::vector<std::int64_t>{6, 7}));
}

class Selection : public ::testing::Test {
 protected:
  Selection() {
    std::vector<sensor_msgs::Image> messages;
    for (const int time_ms : {400, 0, 100, 200, 300, 500}) {  // not stored in order: t0 is the smallest stamp
      messages.push_back(message(grayRamp(), "mono8", kStart + time_ms * kMs));
    }
    store(bag.path(), messages);
  }
  BagFile bag;
  io::RecordingOptions options;
};

TEST_F(Selection, OfAWindowIncludesBothEnds) {
  options.window = io::TimeWindow{0.1, 0.3};
  EXPECT_EQ(readStamps(bag.path(), options), (std::vector<std::int64_t>{100, 200, 300}));
}

TEST_F(Selection, ByRateKeepsTheFirstImageAndThoseAPeriodAfterTheLastKept) {
  options.max_rate_hz = 4.0;
  EXPECT_EQ(readStamps(bag.path(), options), (std::vector<std::int64_t>{0, 300}));
}

TEST_F(Selection, AtTheRateOfTheRecordingKeepsAll) {
  options.max_rate_hz = 10.0;
  EXPECT_EQ(readStamps(bag.path(), options).size(), 6U);
}

TEST_F(Selection, CountsInTheStream) {
  options.window = io::TimeWindow{0.1, 0.3};
  EXPECT_EQ(openBag(bag.path(), {kTopic}, options).front().num_images, 3U);
}

TEST_F(Selection, RefusesWhatSelectsNothing) {
  options.window = io::TimeWindow{0.3, 0.3};
  EXPECT_NE(errorOf([&] { openBag(bag.path(), {kTopic}, options); }).find("empty"), std::string::npos);
  options.window = io::TimeWindow{7.0, 8.0};
  EXPECT_NE(errorOf([&] { openBag(bag.path(), {kTopic}, options); }).find(kTopic), std::string::npos);
  options.window.reset();
  options.max_rate_hz = 0.0;
  EXPECT_NE(errorOf([&] { openBag(bag.path(), {kTopic}, options); }).find("positive"), std::string::npos);
}

/// How messages are stored: all received at one time or not, in chunks that are compressed or not.
struct Storage {
  std::int64_t received_step_ns;
  rosbag::CompressionType compression;
};

std::string contentOf(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

class BagStorage : public ::testing::TestWithParam<Storage> {};

INSTANTIATE_TEST_SUITE_P(BagReader, BagStorage,
                         ::testing::Values(Storage{kMs, rosbag::compression::Uncompressed},
                                           Storage{0, rosbag::compression::Uncompressed},
                                           Storage{kMs, rosbag::compression::BZ2}, Storage{kMs, rosbag::compression::LZ4}));

TEST_P(BagStorage, EveryStampHasItsOwnPixels) {
  const BagFile file;
  {
    rosbag::Bag bag(file.path(), rosbag::bagmode::Write);
    bag.setCompression(GetParam().compression);
    std::int64_t received_ns = kStart;
    for (const int value : {40, 0, 10, 30, 20}) {
      ::ros::Time received;
      received.fromNSec(static_cast<std::uint64_t>(received_ns += GetParam().received_step_ns));
      bag.write(kTopic, received,
                message(cv::Mat(kHeight, kWidth, CV_8UC1, cv::Scalar(value)), "mono8", kStart + value * kMs));
    }
  }
  const std::vector<pipeline::StampedImage> images = readAll(file.path());
  ASSERT_EQ(images.size(), 5U);
  for (std::size_t i = 0; i < images.size(); ++i) {
    const int value = 10 * static_cast<int>(i);
    EXPECT_EQ(images[i].stamp_ns, kStart + value * kMs);
    EXPECT_EQ(images[i].load().at<std::uint8_t>(0, 0), value);
  }
}

TEST(BagReader, ReadsStampsBehindANameOfAnyLength) {
  const BagFile file;
  sensor_msgs::Image image = message(grayRamp(), "mono8", kStart + 3 * kMs);
  image.header.frame_id = std::string(100'000, 'f');
  store<sensor_msgs::Image>(file.path(), {image});
  const std::vector<pipeline::StampedImage> images = readAll(file.path());
  ASSERT_EQ(images.size(), 1U);
  EXPECT_EQ(images[0].stamp_ns, kStart + 3 * kMs);
}

TEST(BagReader, LeavesOutMessagesOfAConnectionThatTheBagDoesNotKnow) {
  const BagFile file;
  store<sensor_msgs::Image>(file.path(), {message(grayRamp(), "mono8")});
  {
    rosbag::Bag bag(file.path(), rosbag::bagmode::Append);
    bag.write("/other", ::ros::Time(1), message(grayRamp(), "mono8"));
  }
  // The last record of the index says of connection 1 where its messages are; here of one that no record describes.
  std::string bytes = contentOf(file.path());
  const std::string record = std::string("conn=") + '\x01' + std::string(3, '\0');
  const std::size_t at = bytes.rfind(std::string("op=") + '\x04');
  ASSERT_NE(at, std::string::npos);
  const std::size_t conn = bytes.rfind(record, at);
  ASSERT_NE(conn, std::string::npos);
  bytes[conn + record.size() - 4] = '\x09';
  std::ofstream(file.path(), std::ios::binary) << bytes;
  EXPECT_EQ(readAll(file.path()).size(), 1U);
}

TEST(BagReader, CanBeReadAgain) {
  const BagFile bag;
  store<sensor_msgs::Image>(bag.path(), {message(grayRamp(), "mono8")});
  const auto streams = openBag(bag.path(), {kTopic}, {});
  for (int pass = 0; pass < 2; ++pass) {
    const pipeline::ImageSource source = streams.front().open();
    ASSERT_TRUE(source().has_value());
    EXPECT_FALSE(source().has_value());
  }
}

TEST(BagReader, ReportsASingleBrokenImageWhereItIsLoaded) {
  const BagFile bag;
  sensor_msgs::Image short_of_data = message(grayRamp(), "mono8", kStart + kMs);
  short_of_data.data.resize(short_of_data.data.size() / 2);
  store<sensor_msgs::Image>(bag.path(), {message(grayRamp(), "mono8"), short_of_data});
  const auto images = readAll(bag.path());
  ASSERT_EQ(images.size(), 2U);
  EXPECT_NO_THROW(images[0].load());
  const std::string error = errorOf([&] { images[1].load(); });
  EXPECT_NE(error.find(kTopic), std::string::npos) << error;
  EXPECT_NE(error.find(std::to_string(kStart + kMs)), std::string::npos) << error;
}

TEST(BagReader, NamesTopicAndEncodingThatItCannotRead) {
  const BagFile bag;
  store<sensor_msgs::Image>(bag.path(), {message(grayRamp(), "32FC1")});
  const std::string error = errorOf([&] { openBag(bag.path(), {kTopic}, {}); });
  EXPECT_NE(error.find("32FC1"), std::string::npos) << error;
  EXPECT_NE(error.find(kTopic), std::string::npos) << error;
}

TEST(BagReader, RefusesCompressedDepth) {
  const BagFile bag;
  sensor_msgs::CompressedImage image;
  image.format = "16UC1; compressedDepth png";
  store<sensor_msgs::CompressedImage>(bag.path(), {image});
  EXPECT_NE(errorOf([&] { openBag(bag.path(), {kTopic}, {}); }).find("compressedDepth"), std::string::npos);
}

TEST(BagReader, ListsTheImageTopicsForOneThatIsNotThere) {
  const BagFile bag;
  {
    BagWriter writer(bag.path());
    writer.writeImage(kTopic, kStart, grayRamp());
    writer.writeImu("/imu0", {});
    writer.close();
  }
  EXPECT_NE(errorOf([&] { openBag(bag.path(), {"/cam1"}, {}); }).find("image topics: " + kTopic), std::string::npos);
  EXPECT_NE(errorOf([&] { openBag(bag.path(), {"/imu0"}, {}); }).find("sensor_msgs/Imu"), std::string::npos);
}

/// A bag with a compressed image and then an image on one topic.
void storeTwoTypes(const std::string& path, boost::shared_ptr<::ros::M_string> connection_of_second) {
  sensor_msgs::CompressedImage first;
  first.format = "png";
  rosbag::Bag bag(path, rosbag::bagmode::Write);
  const ::ros::Time time = ::ros::Time().fromNSec(kStart);
  bag.write(kTopic, time, first);
  bag.write(kTopic, time, message(grayRamp(), "mono8"), std::move(connection_of_second));
}

TEST(BagReader, RefusesATopicWithMessagesOfTwoTypes) {
  using Image = sensor_msgs::Image;
  const BagFile bag;
  auto connection = boost::make_shared<::ros::M_string>();
  (*connection)["type"] = ::ros::message_traits::datatype<Image>();
  (*connection)["md5sum"] = ::ros::message_traits::md5sum<Image>();
  (*connection)["message_definition"] = ::ros::message_traits::definition<Image>();
  storeTwoTypes(bag.path(), connection);
  const std::string error = errorOf([&] { openBag(bag.path(), {kTopic}, {}); });
  for (const char* part : {"several types", "sensor_msgs/CompressedImage and sensor_msgs/Image", "rosbag filter"}) {
    EXPECT_NE(error.find(part), std::string::npos) << error;
  }
}

TEST(BagReader, RefusesMessagesOfAnotherTypeThanTheBagSays) {
  const BagFile bag;
  storeTwoTypes(bag.path(), nullptr);
  const std::string error = errorOf([&] { openBag(bag.path(), {kTopic}, {}); });
  EXPECT_NE(error.find("not of the type that the bag says, sensor_msgs/CompressedImage"), std::string::npos) << error;
  const BagContents contents = listBag(bag.path());
  ASSERT_EQ(contents.image_topics.size(), 1U);
  EXPECT_EQ(contents.image_topics.front().images.size(), 1U);
  EXPECT_EQ(contents.image_topics.front().num_unreadable, 1U);
}

TEST(BagReader, SaysHowToRepairABagThatWasCutOff) {
  const BagFile bag;
  store<sensor_msgs::Image>(bag.path(), {message(grayRamp(), "mono8"), message(grayRamp(), "mono8")});
  std::filesystem::resize_file(bag.path(), std::filesystem::file_size(bag.path()) * 2 / 3);
  EXPECT_NE(errorOf([&] { openBag(bag.path(), {kTopic}, {}); }).find("rosbag reindex"), std::string::npos);
}

TEST(BagReader, NamesABagThatIsMissingOrNone) {
  EXPECT_NE(errorOf([] { openBag("/nowhere/a.bag", {kTopic}, {}); }).find("does not exist"), std::string::npos);
  const BagFile text;
  std::ofstream(text.path()) << "not a bag\n";
  EXPECT_NE(errorOf([&] { openBag(text.path(), {kTopic}, {}); }).find("not a ROS 1 bag"), std::string::npos);
}

}  // namespace
}  // namespace tartan_calib::ros
