#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tartan_calib/io/camchain.h"
#include "tartan_calib/pipeline/calibrate.h"

namespace tartan_calib::apps {

/// How far camera b of one calibration is from the same camera a of another.
struct CameraComparison {
  double rms_px = 0.0;  ///< difference of the projections, the rotation between the camera frames removed
  double max_px = 0.0;
  double rotation_rad = 0.0;   ///< between the two T_cam_rig
  double translation_m = 0.0;  ///< likewise
};

/// Which pixels of calibration a are compared.
struct ComparisonRegion {
  double max_angle_rad = 1.5707963267948966;  ///< from the axis
  std::optional<double> distance_m;           ///< of the points that are compared; empty: infinity
  /// Where given, only around pixels near which every one of these recordings has a corner.
  std::vector<std::vector<pipeline::CameraCorners>> recordings;
};

/// Camera by camera. Throws InputError where the rigs, their images or the recordings do not fit each other.
std::vector<CameraComparison> compareRigs(const calibration::Rig& a, const calibration::Rig& b,
                                          const ComparisonRegion& region);

/// For people: parameters side by side where the models are the same, then the comparison.
std::string comparisonText(const io::Camchain& a, const io::Camchain& b, const ComparisonRegion& region);

}  // namespace tartan_calib::apps
