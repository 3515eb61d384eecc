#pragma once

#include <Eigen/Core>
#include <vector>

#include "radial_pose.h"

namespace tartan_calib::calibration {

/// Points of the image that the radial constraint may hold around: the guess and, where one is better, another within
/// `max_offset` of it per axis. Most likely first. A perspective lens obeys the constraint around every point.
std::vector<Eigen::Vector2d> findDistortionCentres(const std::vector<NormalView>& views, const Eigen::Vector2d& guess,
                                                   double max_offset, int num_threads);

}  // namespace tartan_calib::calibration
