#pragma once

#include <opencv2/core.hpp>
#include <optional>
#include <vector>

#include "tartan_calib/observation/observation.h"
#include "tartan_calib/target/target.h"

namespace tartan_calib::guidance {

/// Stdev [px] of the Gaussian that would blur a step as the board's edges are blurred: the median over edges between
/// neighbouring corners, in the lattice direction that is blurred more. A motion of L pixels alone gives 0.4 L. Empty
/// where no edge is seen well enough, and for circle grids. `gray`: CV_8UC1.
std::optional<double> edgeBlur(const cv::Mat& gray, const std::vector<observation::Corner>& corners,
                               const target::Target& target);

}  // namespace tartan_calib::guidance
