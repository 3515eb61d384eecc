#pragma once

#include <string>
#include <vector>

#include "calibrate_cameras/arguments.h"
#include "live/parameters.h"
#include "tartan_calib/guidance/guide.h"
#include "tartan_calib/guidance/newest_view.h"

namespace tartan_calib::apps {

/// What the coverage node is asked to do.
struct CoverageOptions {
  std::vector<std::string> topics;  ///< subscribed to, one per camera
  Arguments calibration;            ///< of the kept views: as of a command line of calibrate_cameras
  std::string command;              ///< that command line
  guidance::GuideOptions guide;
  guidance::NewestViewOptions input;
  int overlay_width_px = 800;
};

/// Throws UsageError that names the parameter, or the flag in ~options.
CoverageOptions coverageOptions(Parameters parameters, const ::ros::NodeHandle& node);

}  // namespace tartan_calib::apps
