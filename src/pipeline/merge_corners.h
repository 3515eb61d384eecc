#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "tartan_calib/detection/board_map.h"
#include "tartan_calib/observation/observation.h"

namespace tartan_calib::pipeline {

/// Corners that another view of the board showed, refined by symmetry in the image itself. `half_window_m`: on the board; 0
/// (circle grids, which have no X-corners) leaves them as they are. Those that nothing symmetric is near are left out.
std::vector<observation::Corner> refineInImage(const cv::Mat& gray, const detection::BoardMap& map,
                                               const std::vector<Eigen::Vector3d>& target_points, double half_window_m,
                                               const std::vector<observation::Corner>& corners);

/// Adds corners to those known, by increasing id and each id once; not those that are much farther from their predictions
/// than most, nor any where there is no prediction. Where both have a corner, the one known stays unless the
/// other is nearer to the prediction by more than two refinements of one corner ever differ.
void mergeCorners(const std::vector<observation::Corner>& more, const detection::BoardMap& map,
                  const std::vector<Eigen::Vector3d>& target_points, std::vector<observation::Corner>& corners);

}  // namespace tartan_calib::pipeline
