#pragma once

#include <Eigen/Core>

#include "tartan_calib/camera/model.h"

namespace tartan_calib::camera {

/// Extended unified camera model (Khomutenko, Garcia and Martinet 2016):
///   d = sqrt(beta (x^2 + y^2) + z^2),  m = (x, y) / (alpha d + (1 - alpha) z).
/// Valid for z > -w d, w = alpha / (1 - alpha) where alpha <= 1/2, else (1 - alpha) / alpha.
/// Parameters [alpha, beta, fu, fv, cu, cv].
class EucmShape {
 public:
  static constexpr const char* kName = "eucm-none";
  static constexpr const char* kKalibrModel = "eucm";
  static constexpr const char* kKalibrDistortion = "none";
  static constexpr int kNumLeading = 2;
  static constexpr int kNumTrailing = 0;
  using Parameters = Eigen::Vector2d;

  explicit EucmShape(const Parameters& shape) : alpha_(shape(0)), beta_(shape(1)) {}

  static Parameters start() { return {0.5, 1.0}; }
  static Parameters lowerBound() { return {0.0, 1e-3}; }
  static Parameters upperBound() { return {1.0 - 1e-6, 1e3}; }

  bool project(const Eigen::Vector3d& p, Eigen::Vector2d& m, Matrix23d* J_m_p, Eigen::Matrix2d* J_m_shape) const;
  bool unproject(const Eigen::Vector2d& m, Eigen::Vector3d& ray) const;

 private:
  double alpha_;
  double beta_;
};

using Eucm = Model<EucmShape>;

}  // namespace tartan_calib::camera
