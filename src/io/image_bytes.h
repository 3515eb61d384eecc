#pragma once

#include <cstdint>
#include <vector>

namespace tartan_calib::io {

/// True where a PNG or JPEG file ends before its image does, as after an interrupted copy. The libraries that decode them
/// would say so on standard error; a JPEG they would fill up with grey. False for every other kind of file.
bool endsEarly(const std::vector<std::uint8_t>& bytes);

}  // namespace tartan_calib::io
