#pragma once

#include <vector>

#include "tartan_calib/camera/camera.h"
#include "tartan_calib/geometry/rigid3.h"

namespace tartan_calib::calibration {

/// A camera and where it sits. The rig frame is the frame of cam0, whose T_cam_rig is the identity.
struct RigCamera {
  camera::Camera camera;
  geometry::Rigid3 T_cam_rig;
};

struct Rig {
  std::vector<RigCamera> cameras;
};

}  // namespace tartan_calib::calibration
