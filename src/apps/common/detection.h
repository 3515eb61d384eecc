#pragma once

#include <functional>
#include <vector>

#include "common/progress_bar.h"
#include "tartan_calib/pipeline/calibrate.h"

namespace tartan_calib::apps {

/// Corners of all topics, with a line and a progress bar for each and its warnings on standard output. `detected`, where
/// there is one, is called after each.
std::vector<pipeline::CameraCorners> detectAll(
    const std::vector<pipeline::CameraStream>& streams, const target::Target& target,
    const pipeline::CalibrateOptions& options, ProgressBar& bar,
    const std::function<void(int camera_index, const pipeline::CameraCorners&)>& detected = {});

}  // namespace tartan_calib::apps
