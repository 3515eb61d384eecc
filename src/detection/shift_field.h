#pragma once

#include <Eigen/Core>
#include <functional>
#include <optional>
#include <vector>

#include "corner_candidate.h"

namespace tartan_calib::detection {

/// Component-wise median of the shifts from prediction of the found corners around one, itself left out; of those that
/// `counts` accepts by index. Empty with too few of them.
std::optional<Eigen::Vector2d> neighbourShift(
    const std::vector<CornerCandidate>& candidates, std::size_t index,
    const std::function<bool(std::size_t)>& counts = [](std::size_t) { return true; });

/// Drops the corners whose shift differs from their neighbours' by more than `max_deviation_px`, and those without
/// neighbours.
void dropDeviating(double max_deviation_px, std::vector<CornerCandidate>& candidates);

}  // namespace tartan_calib::detection
