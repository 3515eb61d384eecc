#pragma once

#include <cmath>
#include <memory>
#include <vector>

#include "support/board_scene.h"
#include "tartan_calib/pipeline/calibrate.h"

/// A lens of 190 degrees that a board is waved in front of, out to its rim.
namespace tartan_calib::pipeline {

constexpr std::int64_t kWidePeriod_ns = 100'000'000;
constexpr std::int64_t kWideFirst_ns = 1'000'000'000;
constexpr std::size_t kNumWideImages = 14;
/// The board leaves the image here: fewer than kWideMinTags tags.
constexpr std::size_t kLeavingImage = 6;
constexpr int kWideMinTags = 30;

inline camera::Camera wideCamera() {
  Eigen::VectorXd parameters(6);
  parameters << -0.2, 0.59, 156.0, 156.0, 321.3, 317.2;
  return {camera::withParameters(camera::modelByName("ds-none"), parameters), 640, 640};
}

inline test_support::BoardPose widePose(std::size_t i) {
  constexpr double kDegree = test_support::kDegree;
  if (i == kLeavingImage) {
    return {0.35, 84.0 * kDegree, 0.4, 0.0, 0.0, 10.0 * kDegree};
  }
  const double azimuth = 2.39996 * static_cast<double>(i);  // the golden angle spreads them
  const double polar = (10.0 + 5.0 * static_cast<double>(i)) * kDegree;
  return {0.45 + 0.01 * static_cast<double>(i), polar,        azimuth, 0.4 * std::sin(azimuth),
          0.35 * std::cos(2.0 * azimuth),       0.5 * azimuth};
}

inline std::vector<StampedImage> wideImages() {
  std::vector<StampedImage> images;
  for (std::size_t i = 0; i < kNumWideImages; ++i) {
    test_support::BoardScene scene(wideCamera());
    scene.add(target::AprilGrid(), widePose(i));
    images.push_back({kWideFirst_ns + static_cast<std::int64_t>(i) * kWidePeriod_ns,
                      [image = scene.expose(0.6, 2.0, i + 1)] { return image.clone(); }});
  }
  return images;
}

/// Where the corners of an image really are, by increasing id.
inline std::vector<simulation::TrueCorner> wideTruth(std::size_t i) {
  const target::AprilGrid grid;
  return simulation::projectCorners(grid, wideCamera(), test_support::poseOf(grid, widePose(i)));
}

/// The recording, rendered once.
inline CameraStream wideStream() {
  static const std::vector<StampedImage> images = wideImages();
  CameraStream stream{"/cam0/image_raw", images.size(), {}};
  stream.open = [] {
    auto next = std::make_shared<std::size_t>(0);
    return [next]() -> std::optional<StampedImage> {
      return *next < images.size() ? std::optional<StampedImage>(images[(*next)++]) : std::nullopt;
    };
  };
  return stream;
}

}  // namespace tartan_calib::pipeline
