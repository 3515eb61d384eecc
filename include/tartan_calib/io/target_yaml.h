#pragma once

#include <string>
#include <vector>

#include "tartan_calib/target/target.h"

namespace tartan_calib::io {

struct LoadedTarget {
  target::Target target;
  std::vector<std::string> warnings;  ///< keys that nothing reads, each with its file
};

/// A target in Kalibr's YAML: required keys, types and ranges are Kalibr's (an int may stand for a float), and for
/// AprilGrids the optional tagFamily, codeOffset and tagBorder. Throws InputError that names file and key, in Kalibr's words
/// where it has some.
LoadedTarget loadTarget(const std::string& path);

/// As loadTarget; `name` stands for the file in messages.
LoadedTarget parseTarget(const std::string& text, const std::string& name);

/// The YAML that loadTarget reads as this target, the optional keys included.
std::string targetText(const target::Target& target);

}  // namespace tartan_calib::io
