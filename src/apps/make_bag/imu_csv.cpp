#include <algorithm>
#include <fstream>
#include <optional>
#include <sstream>

#include "make_bag/make_bag.h"
#include "tartan_calib/error.h"

namespace tartan_calib::apps {
namespace {

/// Empty where the line is not a stamp and six numbers.
std::optional<ros::ImuSample> parseRow(std::string line) {
  std::replace(line.begin(), line.end(), ',', ' ');
  std::istringstream fields(line);
  ros::ImuSample sample;
  Eigen::Vector3d& w = sample.angular_velocity_rad_s;
  Eigen::Vector3d& a = sample.acceleration_m_s2;
  fields >> sample.stamp_ns >> w.x() >> w.y() >> w.z() >> a.x() >> a.y() >> a.z();
  return fields && sample.stamp_ns >= 0 ? std::make_optional(sample) : std::nullopt;
}

bool isHeader(const std::string& line) { return line.find_first_of("0123456789") != 0; }

}  // namespace

std::vector<ros::ImuSample> loadImuCsv(const std::string& path) {
  std::ifstream file(path);
  if (!file) {
    throw InputError("cannot read " + path);
  }
  std::vector<ros::ImuSample> samples;
  std::string line;
  for (int number = 1; std::getline(file, line); ++number) {
    const std::optional<ros::ImuSample> sample = parseRow(line);
    const bool may_be_skipped = line.find_first_not_of(" \t\r") == std::string::npos || (number == 1 && isHeader(line));
    if (sample) {
      samples.push_back(*sample);
    } else if (!may_be_skipped) {
      throw InputError(path + ", line " + std::to_string(number) +
                       ": expected a stamp in nanoseconds, three rotation rates and three accelerations");
    }
  }
  std::stable_sort(samples.begin(), samples.end(),
                   [](const ros::ImuSample& a, const ros::ImuSample& b) { return a.stamp_ns < b.stamp_ns; });
  return samples;
}

}  // namespace tartan_calib::apps
