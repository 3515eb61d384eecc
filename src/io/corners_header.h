#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace tartan_calib::io {

inline constexpr std::string_view kCornersHeader = "camera,stamp_ns,corner_id,u_px,v_px,cov_uu,cov_uv,cov_vv,used";

/// `# cam0 752 480 /cam0/image_raw`
struct CameraLine {
  int index = 0;
  int width = 0;
  int height = 0;
  std::string topic;  ///< the rest of the line; may be empty
};

std::string cameraLine(const CameraLine& camera);

/// Empty where the line is another comment; `is_malformed` where it starts as `# cam` but cannot be read.
struct ParsedCameraLine {
  std::optional<CameraLine> camera;
  bool is_malformed = false;
};

ParsedCameraLine parseCameraLine(std::string_view line);

}  // namespace tartan_calib::io
