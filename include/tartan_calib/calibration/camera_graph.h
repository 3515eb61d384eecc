#pragma once

#include <Eigen/Core>
#include <vector>

#include "tartan_calib/observation/observation.h"

namespace tartan_calib::calibration {

/// How the cameras are connected: views that two cameras share, and corners seen by both in those views. Cameras that see
/// different parts of the board at the same time are connected too.
struct CameraGraph {
  Eigen::MatrixXi shared_views;  ///< symmetric, num_cameras x num_cameras; the diagonal counts a camera's own
  Eigen::MatrixXi shared_corners;
  std::vector<std::vector<int>> groups;  ///< connected components over shared views, by first camera
};

CameraGraph cameraGraph(const std::vector<observation::View>& views, int num_cameras);

/// Connected components of cameras of which every two neighbours share a view.
std::vector<std::vector<int>> connectedGroups(const Eigen::MatrixXi& shared_views);

}  // namespace tartan_calib::calibration
