#pragma once

#include <vector>

#include "tartan_calib/geometry/rigid3.h"

namespace tartan_calib::geometry {

/// Geometric L1 median of rotations on SO(3) by Weiszfeld steps (Hartley, Aftab and Trumpf 2011, "L1 rotation averaging").
/// Up to half of the inputs may be wrong. Needs at least one rotation.
Eigen::Quaterniond medianRotation(const std::vector<Eigen::Quaterniond>& rotations);

/// Geometric median of points (Weiszfeld). Needs at least one point.
Eigen::Vector3d medianPoint(const std::vector<Eigen::Vector3d>& points);

/// Rotation by medianRotation, translation by medianPoint.
Rigid3 medianRigid(const std::vector<Rigid3>& transforms);

}  // namespace tartan_calib::geometry
