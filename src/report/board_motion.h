#pragma once

#include <optional>
#include <vector>

#include "tartan_calib/calibration/solve.h"

namespace tartan_calib::report {

using BoardMotions = std::vector<std::optional<geometry::Vector6d>>;

/// Motion of the board per millisecond in the rig frame around each view, from its neighbours' poses; empty where a
/// neighbour is missing or too far in time, and where the ways from the one and to the other are no line.
BoardMotions boardMotions(const calibration::Solution& solution, const std::vector<Eigen::Vector3d>& points);

}  // namespace tartan_calib::report
