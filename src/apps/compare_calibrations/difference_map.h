#pragma once

#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "compare_calibrations/comparison.h"

namespace tartan_calib::apps {

/// Length of the projections' difference over the image of every camera, all in the same colours.
cv::Mat differenceMap(const io::Camchain& a, const io::Camchain& b, const ComparisonRegion& region,
                      const RigComparison& comparison);

}  // namespace tartan_calib::apps
