#pragma once

#include <Eigen/Core>
#include <vector>

#include "tartan_calib/calibration/solve.h"

namespace tartan_calib::calibration {

/// Residuals (measured minus predicted) of the used corners whose polar angle lies in [from, to).
struct PolarBand {
  double from_rad = 0.0;
  double to_rad = 0.0;
  int num_corners = 0;
  double rms_px = 0.0;  ///< sqrt(mean |e|^2)
};

struct CameraStatistics {
  int num_views = 0;
  int num_corners = 0;                                 ///< used
  Eigen::Vector2d mean_px = Eigen::Vector2d::Zero();   ///< per axis
  Eigen::Vector2d stdev_px = Eigen::Vector2d::Zero();  ///< population stdev per axis
  double rms_px = 0.0;                                 ///< sqrt(mean |e|^2)
  double median_px = 0.0;                              ///< of |e|
  double max_polar_angle_rad = 0.0;                    ///< of the used corners' rays
  std::vector<PolarBand> bands;                        ///< of 10 degrees, up to max_polar_angle_rad
};

/// One entry per camera.
std::vector<CameraStatistics> residualStatistics(const Solution& solution,
                                                 const std::vector<Eigen::Vector3d>& target_points);

}  // namespace tartan_calib::calibration
