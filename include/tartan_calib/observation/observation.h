#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace tartan_calib::observation {

/// A corner of the target seen in an image. Pixel (0, 0) is the centre of the first pixel.
struct Corner {
  int corner_id = -1;  ///< index in the target's corner lattice
  Eigen::Vector2d px = Eigen::Vector2d::Zero();
  Eigen::Matrix2d cov_px2 = Eigen::Matrix2d::Identity();  ///< uncertainty of px; identity where the detector knows nothing
  bool used = true;                                       ///< false: rejected by the last solve
  int round = 0;                                          ///< of recovery that saw it first; 0: the detection
};

/// The corners that one camera saw in one image, by increasing corner_id.
struct CameraView {
  int camera_index = 0;
  std::int64_t stamp_ns = 0;
  std::vector<Corner> corners;
};

/// What the cameras of a rig saw at the same time: at most one CameraView per camera.
struct View {
  std::int64_t stamp_ns = 0;
  std::vector<CameraView> cameras;  ///< by increasing camera_index; cameras without a board are absent
};

}  // namespace tartan_calib::observation
