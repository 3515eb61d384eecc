#pragma once

#include <cstdint>
#include <opencv2/core.hpp>

#include "tartan_calib/camera/camera.h"
#include "tartan_calib/geometry/rigid3.h"

namespace tartan_calib::simulation {

/// A furnished room seen from the rig, as a panorama: lamps, posters, windows, a door, a floor with marks and a foreign
/// checkerboard, so that detectors meet edges, corners and texture that are no board of theirs.
class Room {
 public:
  explicit Room(std::uint64_t seed);

  /// Where each pixel of a camera looks in the panorama, for `view`. Pixels without a ray look anywhere.
  static cv::Mat2f directions(const camera::Camera& camera, const geometry::Rigid3& T_cam_rig);

  /// Grey levels under full light, CV_32FC1, with the rig turned by `heading_rad` about the vertical.
  cv::Mat1f view(const cv::Mat2f& directions, double heading_rad) const;

 private:
  cv::Mat panorama_;  ///< CV_8UC1, longitude to the right twice around, latitude downwards
};

}  // namespace tartan_calib::simulation
