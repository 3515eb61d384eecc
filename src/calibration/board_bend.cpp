#include "tartan_calib/calibration/board_bend.h"

#include <limits>

namespace tartan_calib::calibration {

BoardBend::BoardBend(const std::vector<Eigen::Vector3d>& flat_points)
    : low_m_(Eigen::Array2d::Constant(std::numeric_limits<double>::infinity())) {
  Eigen::Array2d high_m = -low_m_;
  for (const Eigen::Vector3d& p : flat_points) {
    low_m_ = low_m_.min(p.head<2>().array());
    high_m = high_m.max(p.head<2>().array());
  }
  // A board without extent along an axis does not bend along it.
  extent_m_ = (high_m - low_m_).max(std::numeric_limits<double>::min());
}

Eigen::Vector2d BoardBend::at(const Eigen::Vector2d& p_m) const {
  const Eigen::Array2d centred = 2.0 * (p_m.array() - low_m_) / extent_m_ - 1.0;
  return 1.0 - centred.square();
}

}  // namespace tartan_calib::calibration
