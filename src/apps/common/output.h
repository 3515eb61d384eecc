#pragma once

#include <string>

namespace tartan_calib::apps {

/// What the names of files about a recording begin with, as Kalibr has it: a bag's path without its extension, a folder's
/// path.
std::string recordingPrefix(const std::string& recording);

/// Throws InputError where no file can be made at `path`, so that this is known before the work and not after it.
void checkFolderOf(const std::string& path);

}  // namespace tartan_calib::apps
