#pragma once

#include <Eigen/Core>
#include <functional>
#include <optional>

namespace tartan_calib::detection {

/// Where points of the board plane appear in one image: (x, y) in the target frame [m] to pixels; empty where the point has
/// no image. This is all that detection knows of lens and pose.
using BoardMap = std::function<std::optional<Eigen::Vector2d>(const Eigen::Vector2d& p_target_m)>;

}  // namespace tartan_calib::detection
