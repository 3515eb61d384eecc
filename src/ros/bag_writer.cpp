#include "tartan_calib/ros/bag_writer.h"

#include <rosbag/bag.h>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/Imu.h>
#include <sensor_msgs/image_encodings.h>

#include <algorithm>
#include <filesystem>
#include <map>

#include "tartan_calib/error.h"

namespace tartan_calib::ros {
namespace {

std_msgs::Header header(std::int64_t stamp_ns, const std::string& frame_id, std::uint32_t sequence) {
  std_msgs::Header result;
  result.stamp.fromNSec(static_cast<std::uint64_t>(stamp_ns));
  result.frame_id = frame_id;
  result.seq = sequence;
  return result;
}

/// cam0 of /cam0/image_raw.
std::string frameId(const std::string& topic) {
  const std::size_t begin = topic.find_first_not_of('/');
  return begin == std::string::npos ? "" : topic.substr(begin, topic.find('/', begin) - begin);
}

sensor_msgs::Image imageMessage(const cv::Mat& gray) {
  sensor_msgs::Image message;
  message.width = static_cast<std::uint32_t>(gray.cols);
  message.height = static_cast<std::uint32_t>(gray.rows);
  message.step = message.width;
  message.encoding = sensor_msgs::image_encodings::MONO8;
  message.data.reserve(gray.total());
  for (int row = 0; row < gray.rows; ++row) {
    message.data.insert(message.data.end(), gray.ptr(row), gray.ptr(row) + gray.cols);
  }
  return message;
}

sensor_msgs::Imu imuMessage(const ImuSample& sample) {
  constexpr double kNoEstimate = -1.0;  // as sensor_msgs/Imu defines it
  sensor_msgs::Imu message;
  message.angular_velocity.x = sample.angular_velocity_rad_s.x();
  message.angular_velocity.y = sample.angular_velocity_rad_s.y();
  message.angular_velocity.z = sample.angular_velocity_rad_s.z();
  message.linear_acceleration.x = sample.acceleration_m_s2.x();
  message.linear_acceleration.y = sample.acceleration_m_s2.y();
  message.linear_acceleration.z = sample.acceleration_m_s2.z();
  message.orientation_covariance[0] = kNoEstimate;
  return message;
}

}  // namespace

class BagWriter::File {
 public:
  explicit File(const std::string& path) : path_(path), partial_path_(path + ".partial") {
    guarded([this] { bag_.open(partial_path_, rosbag::bagmode::Write); });
  }
  ~File() {
    try {
      bag_.close();
    } catch (const std::exception&) {
      // A full disk was reported by the write that met it; what is left of the bag goes now.
    }
    std::error_code ignored;
    std::filesystem::remove(partial_path_, ignored);
  }
  File(const File&) = delete;
  File& operator=(const File&) = delete;

  template <class Message>
  void write(const std::string& topic, std::int64_t stamp_ns, Message message) {
    guarded([&] {
      message.header = header(stamp_ns, frameId(topic), num_messages_[topic]++);
      bag_.write(topic, std::max(message.header.stamp, ::ros::TIME_MIN), message);
    });
  }

  void finish() {
    guarded([this] {
      bag_.close();
      std::filesystem::rename(partial_path_, path_);
    });
  }

 private:
  template <class Action>
  void guarded(const Action& action) {
    try {
      action();
    } catch (const std::exception& error) {
      throw InputError("cannot write bag " + path_ + ": " + error.what());
    }
  }

  std::string path_;
  std::string partial_path_;
  rosbag::Bag bag_;
  std::map<std::string, std::uint32_t> num_messages_;
};

BagWriter::BagWriter(const std::string& path) : file_(std::make_unique<File>(path)) {}

BagWriter::~BagWriter() = default;

void BagWriter::writeImage(const std::string& topic, std::int64_t stamp_ns, const cv::Mat& gray) {
  if (gray.type() != CV_8UC1 || gray.empty()) {
    throw InputError("only 8-bit grey images can be written to topic " + topic);
  }
  file_->write(topic, stamp_ns, imageMessage(gray));
}

void BagWriter::writeImu(const std::string& topic, const ImuSample& sample) {
  file_->write(topic, sample.stamp_ns, imuMessage(sample));
}

void BagWriter::close() { file_->finish(); }

}  // namespace tartan_calib::ros
