#pragma once

#include <string>
#include <vector>

namespace tartan_calib::apps {

/// What a command line of TartanCalib asks for.
struct TartanCommand {
  bool help = false;
  std::vector<std::string> words;  ///< the same for calibrate_cameras
  std::vector<std::string> notes;  ///< about flags that mean something else here, or nothing

  std::string save_dir = "/data/";
  std::string log_dest = "log";
  std::vector<std::string> debug_modes;
  std::string debug_image_dir;  ///< empty: save_dir
};

/// Understands TartanCalib's flags, and all of calibrate_cameras, which are handed on as they are. As there, `_` may stand
/// for `-`, a flag may be cut short while it stays unambiguous, and a file of `--rig` stands for the flags in it. Throws
/// UsageError that names the flag.
TartanCommand translateTartanFlags(const std::vector<std::string>& command_line);

/// Text of --help.
std::string tartanHelpText();

}  // namespace tartan_calib::apps
