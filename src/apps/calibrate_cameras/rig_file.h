#pragma once

#include <string>
#include <vector>

namespace tartan_calib::apps {

/// The words of a command line with `--rig F` replaced by the flags that the YAML file F holds, one key per flag. They stand
/// first, so that a flag of the command line takes their place, or adds to those that collect. Lists become several words,
/// `true` a flag without a value, `false` nothing; file names among the values are relative to F. Throws InputError where F
/// cannot be read as that.
std::vector<std::string> withRigFile(const std::vector<std::string>& words);

}  // namespace tartan_calib::apps
