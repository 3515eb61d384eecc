#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "tartan_calib/detection/lattice.h"

namespace tartan_calib::detection {

/// Closes further squares on the outer sides of a lattice, one by one, with saddles that it does not have yet. Finds the
/// corners of squares that are too thin for their edges to be traced; on texture it may add a wrong one.
SaddleLattice extendLattice(const cv::Mat& gray, const std::vector<Saddle>& saddles, const SaddleLattice& lattice);

}  // namespace tartan_calib::detection
