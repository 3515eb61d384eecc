#pragma once

#include <string>
#include <vector>

#include "calibrate_cameras/inputs.h"
#include "common/progress_bar.h"

namespace tartan_calib::apps {

/// Writes the pictures that TartanCalib's --debug-modes name as PNG files: of one camera into the folder, of several into
/// cam0, cam1, ... in it. Modes that show images need the streams of `inputs`, which are gone through once more, with the
/// final model; nothing is shown on a screen. `progress` is told of the images of each camera. Throws InputError where a
/// file cannot be written.
void writeDebugPictures(const Inputs& inputs, const pipeline::CalibrationResult& result,
                        const std::vector<std::string>& modes, const std::string& folder, const ProgressCall& progress);

}  // namespace tartan_calib::apps
