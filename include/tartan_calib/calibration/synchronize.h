#pragma once

#include <cstdint>
#include <vector>

#include "tartan_calib/observation/observation.h"

namespace tartan_calib::calibration {

/// Joins single images to views: each stamp goes to the nearest view within tolerance, at most one image of a camera per
/// view. `cameras[i]`: the views of camera i by increasing stamp. Views are returned by increasing stamp.
std::vector<observation::View> synchronize(const std::vector<std::vector<observation::CameraView>>& cameras,
                                           std::int64_t tolerance_ns);

}  // namespace tartan_calib::calibration
