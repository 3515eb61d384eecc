#pragma once

#include <cstdint>
#include <vector>

#include "tartan_calib/simulation/scene.h"
#include "tartan_calib/target/target.h"

namespace tartan_calib::simulation {

/// What a recording for a calibration should contain.
struct RecordingOptions {
  target::Target target = target::AprilGrid{};
  std::vector<SceneCamera> cameras;
  int num_frames = 60;
  double rate_hz = 4.0;
  double reach_ratio = 0.95;    ///< how far the board's centre goes from the axis (0) to the rim of the image (1)
  double max_tilt_rad = 0.75;   ///< of the board about each of its axes
  double blurred_ratio = 0.0;   ///< part of the frames in which the board moves during the exposure
  double max_blur_px = 8.0;     ///< longest mean path of the corners then
  double hand_ratio = 0.0;      ///< part of the frames with a hand before the board
  double exposure_ratio = 1.0;  ///< 1: paper in full light is just below white; 2: it is cut off
  SensorOptions sensor;
  std::uint64_t seed = 1;
};

/// Cameras side by side: camera k of the rig is `baseline_m` to the right of camera k-1 and looks `yaw_rad` further to the
/// right, both to within a hand-made mount's accuracy.
std::vector<SceneCamera> makeRig(const std::vector<SceneCamera>& lenses, double baseline_m, double yaw_rad,
                                 std::uint64_t seed);

/// A scene in which the board is waved through the whole field of view of each camera in turn: its centre winds from the
/// lens' axis towards the rim, where half of the board leaves the image, while distance, tilt and roll swing. The motion
/// is smooth in time. Throws InputError where an option makes no sense.
Scene makeRecording(const RecordingOptions& options);

}  // namespace tartan_calib::simulation
