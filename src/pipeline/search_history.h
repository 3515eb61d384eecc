#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "tartan_calib/camera/camera.h"
#include "tartan_calib/geometry/rigid3.h"

namespace tartan_calib::pipeline {

/// What was known about an image when its corners were last looked for, and whether they were all found.
struct SearchedImage {
  camera::Camera camera;
  geometry::Rigid3 T_cam_target;
  bool is_complete = false;
};

/// Of one camera, by stamp.
using SearchHistory = std::map<std::int64_t, SearchedImage>;

/// Points of the board that the image shows.
int countPredicted(const camera::Camera& camera, const geometry::Rigid3& T_cam_target,
                   const std::vector<Eigen::Vector3d>& target_points);

/// Whether to look again: the predictions have moved so far that something else may be found.
bool hasMoved(const SearchedImage& before, const camera::Camera& camera, const geometry::Rigid3& T_cam_target,
              const std::vector<Eigen::Vector3d>& target_points);

}  // namespace tartan_calib::pipeline
