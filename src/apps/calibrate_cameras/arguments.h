#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tartan_calib/io/recording.h"
#include "tartan_calib/pipeline/calibrate.h"

namespace tartan_calib::apps {

/// What the command line asks for.
struct Arguments {
  bool help = false;
  bool verbose = false;

  std::string recording;            ///< bag or folder; may be empty where corners_file is given
  std::string corners_file;         ///< calibrate these corners instead of images
  std::vector<std::string> topics;  ///< may be empty where corners_file or init_file names them
  std::string target_file;
  std::string init_file;  ///< camchain to start from
  io::RecordingOptions selection;
  pipeline::CalibrateOptions calibrate;  ///< models may be empty where init_file names them

  std::string output_prefix;  ///< of the result files' names; empty: as outputPrefix() says
  bool export_poses = false;
  bool export_corners = false;
  bool report = true;
  bool show_report = true;

  std::vector<std::string> notes;  ///< about flags that have no effect beside the others
};

/// Parses the words after the program's name as parseFlags does; `--rig F` stands for the flags in F. Throws UsageError that
/// names the flag.
Arguments parseArguments(const std::vector<std::string>& words);

/// KALIBR_MANUAL_FOCAL_LENGTH_INIT as a hint in pixels; null stands for an unset variable. Values that are no focal length
/// in pixels (users set it to 1 to be asked for one) are empty.
std::optional<double> focalHint(const char* value);

/// Text of --help.
std::string helpText();

}  // namespace tartan_calib::apps
