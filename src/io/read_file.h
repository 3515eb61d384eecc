#pragma once

#include <string>

namespace tartan_calib::io {

/// The bytes of a file. Throws InputError with the path and the system's reason.
std::string readFile(const std::string& path);

}  // namespace tartan_calib::io
