#pragma once

#include "calibrate_cameras/flags.h"
#include "tartan_calib/detection/corner_recovery.h"

namespace tartan_calib::apps {

/// Sets what `--refinement` and the sizes of its windows ask for. Throws UsageError.
void applyRefinement(const Flags& flags, detection::RecoveryOptions& recovery);

}  // namespace tartan_calib::apps
