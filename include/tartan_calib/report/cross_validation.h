#pragma once

#include <array>
#include <optional>

#include "tartan_calib/pipeline/calibrate.h"
#include "tartan_calib/report/listener.h"

namespace tartan_calib::report {

/// The calibrations of the views with even and with odd index, each started from the result and with the corners that the
/// result used. Empty where a half does not determine a calibration, and where the intrinsics were held fixed.
/// The listener is told percents of both. Throws pipeline::Cancelled where it cancels.
std::optional<std::array<calibration::Solution, 2>> solveHalves(const pipeline::CalibrationResult& result,
                                                                const pipeline::CalibrateOptions& options,
                                                                const Listener& listener = {});

}  // namespace tartan_calib::report
