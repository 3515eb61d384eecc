#pragma once

#include <cmath>

#include "solved_scene.h"

namespace tartan_calib::report {

/// A board waved in front of two cameras side by side, 20 views a second with noise of 0.05 px; the second camera takes its
/// images `delay_ms` after the first, and its stamps do not say so.
test_support::Scene movingScene(double delay_ms);

}  // namespace tartan_calib::report
