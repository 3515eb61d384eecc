#pragma once

#include "tartan_calib/pipeline/calibrate.h"
#include "tartan_calib/target/target.h"
#include "yaml_writer.h"

namespace tartan_calib::io {

/// All options that can change the result; the number of threads cannot.
void addOptions(YamlWriter& yaml, const pipeline::CalibrateOptions& options, const target::Target& target);

/// The target in the keys of target files.
void addTarget(YamlWriter& yaml, const target::Target& target);

}  // namespace tartan_calib::io
