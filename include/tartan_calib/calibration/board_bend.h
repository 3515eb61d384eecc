#pragma once

#include <Eigen/Core>
#include <vector>

namespace tartan_calib::calibration {

/// How a board bends: z(p) += warp_m . at(p), at(p) = [1 - x^2, 1 - y^2] with x, y in [-1, 1] over the board (as mrcal).
class BoardBend {
 public:
  explicit BoardBend(const std::vector<Eigen::Vector3d>& flat_points);

  Eigen::Vector2d at(const Eigen::Vector2d& p_m) const;

 private:
  Eigen::Array2d low_m_;
  Eigen::Array2d extent_m_;
};

}  // namespace tartan_calib::calibration
