#pragma once

#include <Eigen/Core>

#include "tartan_calib/camera/model.h"

namespace tartan_calib::camera {

/// Double sphere (Usenko, Demmel and Cremers 2018, eq. 40-45):
///   d1 = |p|,  k = xi d1 + z,  d2 = sqrt(x^2 + y^2 + k^2),  m = (x, y) / (alpha d2 + (1 - alpha) k).
/// Valid for z > -w2 d1 (eq. 43-45). Parameters [xi, alpha, fu, fv, cu, cv].
class DoubleSphereShape {
 public:
  static constexpr const char* kName = "ds-none";
  static constexpr const char* kKalibrModel = "ds";
  static constexpr const char* kKalibrDistortion = "none";
  static constexpr int kNumLeading = 2;
  static constexpr int kNumTrailing = 0;
  using Parameters = Eigen::Vector2d;

  explicit DoubleSphereShape(const Parameters& shape);

  static Parameters start() { return {0.0, 0.5}; }
  static Parameters lowerBound() { return {-1.0 + 1e-6, 0.0}; }
  static Parameters upperBound() { return {kMaxXi, 1.0 - 1e-6}; }

  bool project(const Eigen::Vector3d& p, Eigen::Vector2d& m, Matrix23d* J_m_p, Eigen::Matrix2d* J_m_shape) const;
  bool unproject(const Eigen::Vector2d& m, Eigen::Vector3d& ray) const;

 private:
  static constexpr double kMaxXi = 20.0;  ///< as for omni, which is alpha = 0

  double xi_;
  double alpha_;
  double min_cosine_;  ///< -w2
};

using DoubleSphere = Model<DoubleSphereShape>;

}  // namespace tartan_calib::camera
