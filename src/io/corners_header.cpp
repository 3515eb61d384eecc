#include "corners_header.h"

#include <charconv>

namespace tartan_calib::io {
namespace {

constexpr std::string_view kPrefix = "# cam";
constexpr int kMaxCameras = 1000;
constexpr int kMaxResolution = 100000;

/// Takes a whole number from the front of `text`.
bool takeInt(std::string_view& text, int& value) {
  const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc()) {
    return false;
  }
  text.remove_prefix(static_cast<std::size_t>(stop - text.data()));
  return true;
}

bool takeBlank(std::string_view& text) {
  const bool is_blank = !text.empty() && text.front() == ' ';
  text.remove_prefix(is_blank ? 1 : 0);
  return is_blank;
}

}  // namespace

std::string cameraLine(const CameraLine& camera) {
  return std::string(kPrefix) + std::to_string(camera.index) + " " + std::to_string(camera.width) + " " +
         std::to_string(camera.height) + " " + camera.topic;
}

ParsedCameraLine parseCameraLine(std::string_view line) {
  if (line.substr(0, kPrefix.size()) != kPrefix) {
    return {};
  }
  line.remove_prefix(kPrefix.size());
  CameraLine camera;
  const bool is_read = takeInt(line, camera.index) && takeBlank(line) && takeInt(line, camera.width) && takeBlank(line) &&
                       takeInt(line, camera.height) && (line.empty() || takeBlank(line));
  const auto is_size = [](int pixels) { return pixels > 0 && pixels <= kMaxResolution; };
  if (!is_read || camera.index < 0 || camera.index >= kMaxCameras || !is_size(camera.width) || !is_size(camera.height)) {
    return {std::nullopt, true};
  }
  camera.topic = std::string(line);
  return {camera, false};
}

}  // namespace tartan_calib::io
