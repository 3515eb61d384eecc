#pragma once

#include <functional>
#include <string>
#include <vector>

#include "common/progress_bar.h"
#include "tartan_calib/ros/bag_writer.h"

namespace tartan_calib::apps {

/// What a bag was made of.
struct BagContents {
  std::size_t num_images = 0;
  std::size_t num_imu_samples = 0;
  std::size_t num_skipped_images = 0;  ///< could not be decoded
};

/// kalibr_bagcreater's work: `<folder>/<camera>/<stamp_ns>.png` (jpg, bmp, pgm) become mono8 images on /<camera>/image_raw,
/// and `<folder>/imu*.csv` become sensor_msgs/Imu on /imu*. Messages are stored by increasing stamp. `notice` is told of
/// files that are left out. Where `progress`, told after every image, throws, nothing is left behind.
BagContents makeBag(const std::string& folder, const std::string& bag_path,
                    const std::function<void(const std::string&)>& notice, const ProgressCall& progress = {});

/// Rows `stamp_ns, wx, wy, wz, ax, ay, az` (rad/s, m/s^2) by increasing stamp; a first line without numbers is a header.
/// Throws InputError that names file and line.
std::vector<ros::ImuSample> loadImuCsv(const std::string& path);

}  // namespace tartan_calib::apps
