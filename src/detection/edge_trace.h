#pragma once

#include <array>
#include <opencv2/core.hpp>
#include <vector>

#include "tartan_calib/detection/saddle.h"

namespace tartan_calib::detection {

/// Where an arm leads to: an arm of another saddle, or nowhere (saddle_index < 0).
struct ArmLink {
  int saddle_index = -1;
  int arm = -1;
};

using ArmLinks = std::array<ArmLink, 4>;

/// Follows every arm of every saddle along its edge to the next saddle. Links come in pairs: a's arm i leads to b's arm j
/// exactly where b's arm j leads to a's arm i. Dark lies on the same side of the edge at both ends, so one of i and j is
/// even.
std::vector<ArmLinks> linkSaddles(const cv::Mat& gray, const std::vector<Saddle>& saddles);

}  // namespace tartan_calib::detection
