#pragma once

#include <string>

#include "tartan_calib/pipeline/calibrate.h"

namespace tartan_calib::io {

/// Where a calibration came from.
struct RunInfo {
  std::string recording;  ///< bag, folder or corners file
  std::string target_file;
  std::string command;  ///< the command line
};

/// Everything that a report needs, as YAML: version, run, options, target, cameras with statistics by polar angle,
/// covariance, poses, graph and warnings. The same bytes for the same result: no clock times.
std::string calibrationText(const pipeline::CalibrationResult& result, const pipeline::CalibrateOptions& options,
                            const RunInfo& run);

}  // namespace tartan_calib::io
