#pragma once

#include "validate_calibration/validate_options.h"

namespace tartan_calib::apps {

/// Opens, detects, validates, tells on standard output, writes the files. Throws InputError and CalibrationError.
void validateCalibration(const ValidateOptions& options);

}  // namespace tartan_calib::apps
