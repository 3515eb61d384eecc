#pragma once

#include <string>
#include <vector>

#include "tartan_calib/io/camchain.h"

namespace tartan_calib::apps {

/// How far camera b of one calibration is from the same camera a of another.
struct CameraComparison {
  double rms_px = 0.0;  ///< difference of the projections, the rotation between the camera frames removed
  double max_px = 0.0;
  double rotation_rad = 0.0;   ///< between the two T_cam_rig
  double translation_m = 0.0;  ///< likewise
};

/// Camera by camera, over the pixels of a within `max_angle_rad` of its axis. Throws InputError where the rigs or their
/// images do not fit each other.
std::vector<CameraComparison> compareRigs(const calibration::Rig& a, const calibration::Rig& b, double max_angle_rad);

/// For people: parameters side by side where the models are the same, then the comparison.
std::string comparisonText(const io::Camchain& a, const io::Camchain& b, double max_angle_rad);

}  // namespace tartan_calib::apps
