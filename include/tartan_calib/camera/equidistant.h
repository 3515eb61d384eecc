#pragma once

#include <Eigen/Core>
#include <limits>

#include "tartan_calib/camera/model.h"

namespace tartan_calib::camera {

/// Kannala-Brandt (2006) on the true angle from the axis: theta = atan2(|xy|, z),
///   m = (x, y) / |xy| * theta_d,  theta_d = theta (1 + k1 theta^2 + k2 theta^4 + k3 theta^6 + k4 theta^8).
/// Equals Kalibr's and OpenCV's below 90 degrees and goes on beyond, to the angle at which theta_d stops growing.
/// Parameters [fu, fv, cu, cv, k1, k2, k3, k4].
class EquidistantShape {
 public:
  static constexpr const char* kName = "pinhole-equi";
  static constexpr const char* kKalibrModel = "pinhole";
  static constexpr const char* kKalibrDistortion = "equidistant";
  static constexpr int kNumLeading = 0;
  static constexpr int kNumTrailing = 4;
  using Parameters = Eigen::Vector4d;

  explicit EquidistantShape(const Parameters& k);

  static Parameters start() { return Parameters::Zero(); }
  static Parameters lowerBound() { return Parameters::Constant(-std::numeric_limits<double>::infinity()); }
  static Parameters upperBound() { return Parameters::Constant(std::numeric_limits<double>::infinity()); }

  bool project(const Eigen::Vector3d& p, Eigen::Vector2d& m, Matrix23d* J_m_p, Eigen::Matrix<double, 2, 4>* J_m_shape) const;
  bool unproject(const Eigen::Vector2d& m, Eigen::Vector3d& ray) const;

 private:
  double distortedAngle(double theta_rad) const;
  double slope(double theta_rad) const;  ///< d(theta_d) / d(theta)

  Parameters k_;
  double max_theta_rad_;    ///< first angle at which theta_d stops growing, at most pi
  double max_theta_d_rad_;  ///< theta_d there
};

using PinholeEqui = Model<EquidistantShape>;

}  // namespace tartan_calib::camera
