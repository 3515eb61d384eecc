#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "board_image.h"
#include "tartan_calib/pipeline/camera_stream.h"

namespace tartan_calib::pipeline {

inline target::AprilGrid smallGrid() {
  target::AprilGrid grid;
  grid.tag_rows = 4;
  grid.tag_cols = 4;
  return grid;
}

constexpr std::int64_t kPeriod_ns = 50'000'000;

/// Images of the board, 50 ms apart from stamp 50 ms on.
inline std::vector<StampedImage> boardImages(int count, const Pinhole& pinhole = {}) {
  std::vector<StampedImage> images;
  for (int i = 0; i < count; ++i) {
    cv::Mat image = drawBoard(smallGrid(), pinhole, boardPose(smallGrid(), i));
    images.push_back({(i + 1) * kPeriod_ns, [image] { return image; }});
  }
  return images;
}

inline CameraStream streamOf(const std::vector<StampedImage>& images) {
  CameraStream stream;
  stream.topic = "/cam0/image_raw";
  stream.num_images = images.size();
  stream.open = [images] {
    auto next = std::make_shared<std::size_t>(0);
    return [images, next]() -> std::optional<StampedImage> {
      return *next < images.size() ? std::optional<StampedImage>(images[(*next)++]) : std::nullopt;
    };
  };
  return stream;
}

}  // namespace tartan_calib::pipeline
