#pragma once

#include <string>

#include "tartan_calib/pipeline/calibrate.h"

namespace tartan_calib::io {

/// Kalibr's --export-poses: T_target_cam0 of every view of the solution under Kalibr's header. The quaternion is Hamilton's
/// in the header's order w, x, y, z (Kalibr writes JPL's x, y, z, w under the same header).
std::string posesText(const pipeline::CalibrationResult& result);

}  // namespace tartan_calib::io
