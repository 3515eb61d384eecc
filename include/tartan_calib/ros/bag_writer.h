#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <opencv2/core.hpp>
#include <string>

namespace tartan_calib::ros {

/// What an inertial sensor measured at one time.
struct ImuSample {
  std::int64_t stamp_ns = 0;
  Eigen::Vector3d angular_velocity_rad_s = Eigen::Vector3d::Zero();
  Eigen::Vector3d acceleration_m_s2 = Eigen::Vector3d::Zero();
};

/// Writes a ROS 1 bag that is there whole or not at all: it has a temporary name until `close`. Messages are stored under
/// their header stamps; written by increasing stamp, readers need not seek. Failures throw InputError that names the bag.
class BagWriter {
 public:
  explicit BagWriter(const std::string& path);
  ~BagWriter();  ///< without a `close` before, removes what was written
  BagWriter(const BagWriter&) = delete;
  BagWriter& operator=(const BagWriter&) = delete;

  /// sensor_msgs/Image of encoding mono8; `gray` is CV_8UC1.
  void writeImage(const std::string& topic, std::int64_t stamp_ns, const cv::Mat& gray);

  /// sensor_msgs/Imu without orientation.
  void writeImu(const std::string& topic, const ImuSample& sample);

  void close();

 private:
  class File;
  std::unique_ptr<File> file_;
};

}  // namespace tartan_calib::ros
