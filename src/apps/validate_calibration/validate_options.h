#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "tartan_calib/io/recording.h"

namespace tartan_calib::apps {

struct ValidateOptions {
  std::string recording;            ///< bag or folder; may be empty where corners_file is given
  std::string corners_file;         ///< corners instead of images
  std::string camchain_file;        ///< the calibration under test
  std::vector<std::string> topics;  ///< empty: the camchain's
  std::string target_file;
  io::RecordingOptions selection;
  std::int64_t approx_sync_ns = 20'000'000;
  int num_threads = 0;                ///< of the detection; 0: all cores
  std::optional<double> expected_px;  ///< rms to judge by; empty: what the calibration's own results file says
  std::string picture_file;           ///< empty: none
  std::string errors_file;            ///< likewise; CSV
};

/// Nothing where help is asked for. Throws UsageError that names the flag.
std::optional<ValidateOptions> parseValidateOptions(const std::vector<std::string>& words);

std::string validateHelp();

}  // namespace tartan_calib::apps
