#pragma once

#include <cstdint>
#include <vector>

#include "tartan_calib/observation/observation.h"

namespace tartan_calib::calibration {

/// Joins images of several cameras to views, nearest stamps first, at most one image of a camera per view. The stamp of a
/// view is that of its camera with the lowest index; no image is further than the tolerance from it. `cameras[i]`: the
/// images of camera i in any order. Views are returned by increasing stamp.
std::vector<observation::View> synchronize(const std::vector<std::vector<observation::CameraView>>& cameras,
                                           std::int64_t tolerance_ns);

}  // namespace tartan_calib::calibration
