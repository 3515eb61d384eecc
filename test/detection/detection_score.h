#pragma once

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <vector>

#include "tartan_calib/detection/target_detector.h"
#include "tartan_calib/simulation/true_corner.h"

namespace tartan_calib::detection {

/// How a detection compares with the corners that were drawn.
struct Score {
  int found = 0;
  int wrong = 0;  ///< further than kMaxError_px from the truth, or not drawn
  double median_error_px = 0.0;
  double rms_normalized_error = 0.0;  ///< per axis, in units of the stated standard deviation
};

inline Score score(const Detection& detection, const std::vector<simulation::TrueCorner>& truth) {
  constexpr double kMaxError_px = 1.0;
  std::vector<double> errors_px;
  double normalized2 = 0.0;
  Score result;
  for (const observation::Corner& corner : detection.corners) {
    const auto match =
        std::find_if(truth.begin(), truth.end(), [&](const auto& t) { return t.corner_id == corner.corner_id; });
    if (match == truth.end() || (match->px - corner.px).norm() > kMaxError_px) {
      ++result.wrong;
      continue;
    }
    const Eigen::Vector2d error_px = corner.px - match->px;
    errors_px.push_back(error_px.norm());
    normalized2 += error_px.dot(corner.cov_px2.inverse() * error_px);
  }
  result.found = static_cast<int>(errors_px.size());
  if (!errors_px.empty()) {
    const auto middle = errors_px.begin() + static_cast<std::ptrdiff_t>(errors_px.size() / 2);
    std::nth_element(errors_px.begin(), middle, errors_px.end());
    result.median_error_px = *middle;
    result.rms_normalized_error = std::sqrt(normalized2 / (2.0 * static_cast<double>(errors_px.size())));
  }
  return result;
}

}  // namespace tartan_calib::detection
