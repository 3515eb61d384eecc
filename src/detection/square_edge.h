#pragma once

#include <opencv2/core.hpp>
#include <optional>
#include <vector>

#include "edge_trace.h"

namespace tartan_calib::detection {

/// How far it is along the edge between two arms [px], more where the edge has to bend for it; nothing where the image is
/// not dark on one side and light on the other, as the arms say, all along the curve that leaves both saddles along their
/// arms. Unlike a traced edge it needs no step after step, so that short, thin and blurred squares do.
std::optional<double> squareEdgeCost(const cv::Mat& gray, const std::vector<Saddle>& saddles, const ArmLink& from,
                                     const ArmLink& to);

}  // namespace tartan_calib::detection
