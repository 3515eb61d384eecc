#pragma once

#include <functional>
#include <string>

#include "calibrate_cameras/arguments.h"
#include "calibrate_cameras/inputs.h"

namespace tartan_calib::apps {

/// What a program does besides, with the inputs and the result so far. Any member may stay empty.
struct SessionHooks {
  using Hook = std::function<void(const Inputs&, const pipeline::CalibrationResult&)>;

  Hook detection_solved;  ///< what comes out where there are no rounds
  Hook finished;          ///< after the files are written
};

/// Calibrates as the arguments say, tells about it on the terminal and writes the files. `command`: the command line, kept
/// in the calibration file.
void runSession(const Arguments& arguments, const std::string& command, const SessionHooks& hooks = {});

/// The words of a command line behind the program's name, as a shell takes them.
std::string commandText(const std::string& program, const std::vector<std::string>& words);

}  // namespace tartan_calib::apps
