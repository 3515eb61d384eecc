#pragma once

#include <cstdint>
#include <map>

#include "tartan_calib/pipeline/calibrate.h"

namespace tartan_calib {

/// Place of the board before a camera that is known, by stamp: of each image with corners enough.
inline std::map<std::int64_t, geometry::Rigid3> boardPoses(const pipeline::CameraCorners& corners,
                                                           const target::Target& target, const calibration::Rig& rig) {
  pipeline::CalibrateOptions options;
  options.models = {camera::modelName(rig.cameras.front().camera.model)};
  options.known_rig = rig;
  options.solve.fix_intrinsics = true;
  const calibration::Solution solution = pipeline::calibrateCorners({corners}, target, options).solution;
  std::map<std::int64_t, geometry::Rigid3> poses;
  for (std::size_t i = 0; i < solution.views.size(); ++i) {
    poses[solution.views[i].stamp_ns] = solution.T_rig_target[i];
  }
  return poses;
}

}  // namespace tartan_calib
