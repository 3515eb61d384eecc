#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tartan_calib/io/recording.h"

namespace tartan_calib::apps {

struct DetectOptions {
  std::string recording;  ///< bag or folder
  std::vector<std::string> topics;
  std::string target_file;
  io::RecordingOptions selection;
  double min_border_distance_px = 4.0;
  int num_threads = 0;         ///< 0: all cores
  std::string output;          ///< CSV file
  std::string picture_folder;  ///< empty: no pictures
  int max_pictures = 100;      ///< of all topics together
};

/// Nothing where help is asked for. Throws UsageError that names the flag.
std::optional<DetectOptions> parseDetectOptions(const std::vector<std::string>& words);

std::string detectHelp();

}  // namespace tartan_calib::apps
