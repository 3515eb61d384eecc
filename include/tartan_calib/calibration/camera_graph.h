#pragma once

#include <Eigen/Core>
#include <string>
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

/// Throws CalibrationError with the groups and the shared views per pair where cameras are not connected. `shared` says what
/// counts as a shared view, `remedy` what helps.
void requireConnected(const Eigen::MatrixXi& shared_views, const std::string& shared, const std::string& remedy);

}  // namespace tartan_calib::calibration
