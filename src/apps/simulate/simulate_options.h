#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace tartan_calib::apps {

/// What `simulate` was asked for.
struct SimulateOptions {
  std::string lens = "fisheye190";
  std::vector<std::string> models = {"ds-none"};  ///< one for all cameras or one for each
  int num_cameras = 1;
  int width = 0;  ///< [px]; 0: the lens' own
  int height = 0;
  double baseline_m = 0.12;
  double yaw_deg = 0.0;
  double delay_ms = 0.0;  ///< of each camera against the one before, in what it sees; the stamps are equal
  int num_views = 60;
  double rate_hz = 4.0;
  double reach_ratio = 0.95;
  std::optional<double> tilt_deg;  ///< empty: as people tilt boards
  double blurred_ratio = 0.0;
  double max_blur_px = 8.0;
  double hand_ratio = 0.0;
  double psf_sigma_px = 0.6;
  double exposure_ratio = 1.0;
  double noise_grey = 2.0;  ///< standard deviation at half of full scale
  std::string target_file;  ///< empty: Kalibr's 6x6 AprilGrid with tags of 88 mm
  std::string output_bag;   ///< one of the two is given
  std::string output_dir;
  std::uint64_t seed = 1;
  int num_threads = 0;  ///< 0: all cores
};

/// Options of a command line without the program's name; a `--preset` sets those that are not given. Empty where the user
/// asked for help. Throws UsageError.
std::optional<SimulateOptions> parseSimulateOptions(const std::vector<std::string>& arguments);

std::string simulateHelp();

}  // namespace tartan_calib::apps
