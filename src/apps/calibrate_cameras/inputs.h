#pragma once

#include <functional>
#include <string>
#include <vector>

#include "calibrate_cameras/arguments.h"
#include "tartan_calib/pipeline/calibrate.h"
#include "tartan_calib/target/target.h"

namespace tartan_calib::apps {

/// Everything a calibration needs, opened and checked against each other.
struct Inputs {
  std::string dataset;  ///< bag, folder or corners file
  target::Target target;
  std::vector<std::string> topics;  ///< one per camera
  pipeline::CalibrateOptions options;
  std::vector<pipeline::CameraStream> streams;   ///< empty where corners are given
  std::vector<pipeline::CameraCorners> corners;  ///< empty where images are given
};

/// Opens what the arguments name, the cheap things first. `warn` is told what a user should know of. Throws InputError.
Inputs openInputs(const Arguments& arguments, const std::function<void(const std::string&)>& warn);

/// Calibrates from corners where there are any, else from images.
pipeline::CalibrationResult calibrate(const Inputs& inputs, const pipeline::Listener& listener);

}  // namespace tartan_calib::apps
