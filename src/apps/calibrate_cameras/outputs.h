#pragma once

#include <string>
#include <vector>

#include "calibrate_cameras/arguments.h"
#include "tartan_calib/pipeline/calibrate.h"

namespace tartan_calib::apps {

/// What all result files begin with, as Kalibr has it: a bag's path without its extension, a folder's path; of corners alone
/// their file's path without `-corners.csv`.
std::string outputPrefix(const Arguments& arguments);

/// Throws InputError where no file can be made there, so that this is known before the work and not after it.
void checkWritable(const std::string& prefix);

/// Files of one run; empty where not written.
struct OutputFiles {
  std::string camchain;
  std::string results;
  std::string calibration;
  std::string poses;
  std::string corners;
};

/// What a run of these arguments writes, besides the report.
OutputFiles outputFiles(const Arguments& arguments);

/// Throws InputError where one of these files, or of `more_outputs`, is to be read as well.
void checkInputsStay(const Arguments& arguments, const std::vector<std::string>& more_outputs = {});

/// All files are written whole, or none of them is. `command` is kept in the calibration file.
OutputFiles writeOutputs(const pipeline::CalibrationResult& result, const Arguments& arguments,
                         const pipeline::CalibrateOptions& options, const std::string& command);

}  // namespace tartan_calib::apps
