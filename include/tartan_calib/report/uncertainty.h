#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "tartan_calib/calibration/solve.h"

namespace tartan_calib::report {

/// How uncertain a solution's projection is, from its covariance: the stdev [px], in the worst direction, of where a far
/// point seen at each of `samples_px` is projected by a calibration from as many views with other noise. What a rotation of
/// the camera frame takes up (it is fitted over `aligned_px`, where the data are) is no error. Empty where a pixel has no
/// ray.
std::vector<std::optional<double>> projectionStdevs(const calibration::Solution& solution, int camera_index,
                                                    const std::vector<Eigen::Vector2d>& aligned_px,
                                                    const std::vector<Eigen::Vector2d>& samples_px);

}  // namespace tartan_calib::report
