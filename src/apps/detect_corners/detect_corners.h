#pragma once

#include <string>

#include "detect_corners/detect_options.h"
#include "tartan_calib/pipeline/calibrate.h"

namespace tartan_calib::apps {

/// What was found in one topic, for people.
std::string detectionText(const pipeline::CameraCorners& corners, int camera_index, const target::Target& target);

/// Detects, tells on standard output what was found, and writes the files. Throws InputError where nothing can be read,
/// CalibrationError where no image shows the board.
void detectCorners(const DetectOptions& options);

}  // namespace tartan_calib::apps
