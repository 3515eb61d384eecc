#pragma once

#include <vector>

#include "tartan_calib/pipeline/calibrate.h"
#include "tartan_calib/report/seen_corners.h"

namespace tartan_calib::report {

/// When a camera of a rig takes its images, against the other cameras in the same views.
struct CameraTiming {
  int camera_index = 1;
  int num_views = 0;           ///< shared with other cameras, with a known motion of the board
  double median_stamp_ns = 0;  ///< distance of its stamp from another camera's in the view: median
  /// How much later the camera sees the board than cam0 does in the same view, whatever the stamps say: the residuals of
  /// both, each fitted by the board's motion in the image.
  double delay_ns = 0.0;
  double delay_stdev_ns = 0.0;
  double speed_px_per_ms = 0.0;  ///< of the board in the camera's image: rms over the corners
};

/// For every camera but cam0 that shares views with others while the board moves. `corners`: seenCorners(result).
std::vector<CameraTiming> cameraTimings(const pipeline::CalibrationResult& result, const std::vector<SeenCorners>& corners);

}  // namespace tartan_calib::report
