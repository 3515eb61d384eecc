#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "tartan_calib/geometry/rigid3.h"

namespace tartan_calib::calibration {

/// Where one camera of a view sees the board, and from how many corners that is known.
struct CameraPose {
  int camera_index = 0;
  int num_corners = 0;
  geometry::Rigid3 T_cam_target;
};

/// The cameras of one view that know their pose.
using ViewPoses = std::vector<CameraPose>;

/// In how many views each two cameras both know their pose. Symmetric.
Eigen::MatrixXi sharedPoses(const std::vector<ViewPoses>& views, int num_cameras);

/// T_cam_rig of every camera, the first one's the identity: along the spanning tree over the pairs that share most corners,
/// each step by the median over the shared views. Needs connected cameras.
std::vector<geometry::Rigid3> treeExtrinsics(const std::vector<ViewPoses>& views, int num_cameras);

}  // namespace tartan_calib::calibration
