#pragma once

#include "tartan_calib/target/target.h"
#include "yaml_writer.h"

namespace tartan_calib::io {

/// The keys of a target file.
void addTargetKeys(YamlWriter& yaml, const target::Target& target);

}  // namespace tartan_calib::io
