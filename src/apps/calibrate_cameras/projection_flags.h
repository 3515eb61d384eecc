#pragma once

#include <string>
#include <vector>

#include "calibrate_cameras/flags.h"
#include "tartan_calib/pipeline/virtual_view.h"

namespace tartan_calib::apps {

/// What `--projections` with `--fovs`, `--poses` and `--resolutions` asks for, in TartanCalib's columns: a value for each
/// projection in a first row, then a value for each in a second. Throws UsageError.
pipeline::Projections projectionsFrom(const Flags& flags);

/// A line on each of these flags that describes none of the views.
std::vector<std::string> notesOnProjections(const Flags& flags);

}  // namespace tartan_calib::apps
