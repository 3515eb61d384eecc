#pragma once

#include <array>
#include <cstdarg>
#include <cstdio>
#include <string>
#include <vector>

namespace tartan_calib {

std::string format(const char* pattern, ...) __attribute__((format(printf, 1, 2)));

/// As printf into a string, for one line of text.
inline std::string format(const char* pattern, ...) {
  std::array<char, 1024> text{};
  va_list arguments;
  va_start(arguments, pattern);
  std::vsnprintf(text.data(), text.size(), pattern, arguments);
  va_end(arguments);
  return text.data();
}

inline std::string joined(const std::vector<std::string>& parts, const std::string& separator = ", ") {
  std::string text;
  for (const std::string& part : parts) {
    text += (text.empty() ? "" : separator) + part;
  }
  return text;
}

/// What files and messages call the camera of an index.
template <typename Integer>
std::string cameraName(Integer index) {
  return "cam" + std::to_string(index);
}

}  // namespace tartan_calib
