#pragma once

#include <Eigen/Core>
#include <vector>

#include "radial_pose.h"

namespace tartan_calib::calibration {

/// The point of the image that the radial constraint holds around, within `max_offset` of `guess` per axis. The guess itself
/// where no other point is clearly better: a perspective lens obeys the constraint around every point.
Eigen::Vector2d findDistortionCentre(const std::vector<NormalView>& views, const Eigen::Vector2d& guess, double max_offset);

}  // namespace tartan_calib::calibration
