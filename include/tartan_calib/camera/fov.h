#pragma once

#include <Eigen/Core>
#include <cmath>

#include "tartan_calib/camera/model.h"

namespace tartan_calib::camera {

/// FOV model (Devernay and Faugeras 2001): m = (x, y) / |xy| * atan2(2 |xy| tan(w/2), z) / w.
/// The two-argument arc tangent continues it beyond 90 degrees. Parameters [fu, fv, cu, cv, w].
class FovShape {
 public:
  static constexpr const char* kName = "pinhole-fov";
  static constexpr const char* kKalibrModel = "pinhole";
  static constexpr const char* kKalibrDistortion = "fov";
  static constexpr int kNumLeading = 0;
  static constexpr int kNumTrailing = 1;
  using Parameters = Eigen::Matrix<double, 1, 1>;

  explicit FovShape(const Parameters& w) : w_(w(0)), slope_(2.0 * std::tan(0.5 * w(0))) {}

  static Parameters start() { return Parameters::Constant(1.0); }
  static Parameters lowerBound() { return Parameters::Constant(kMinW); }
  static Parameters upperBound() { return Parameters::Constant(kMaxW); }

  bool project(const Eigen::Vector3d& p, Eigen::Vector2d& m, Matrix23d* J_m_p, Eigen::Matrix<double, 2, 1>* J_m_shape) const;
  bool unproject(const Eigen::Vector2d& m, Eigen::Vector3d& ray) const;

 private:
  static constexpr double kMinW = 1e-3;  ///< here the model is a pinhole to 1e-7
  static constexpr double kMaxW = 3.0;   ///< tan(w/2) grows without bound at pi

  double w_;
  double slope_;  ///< 2 tan(w/2)
};

using PinholeFov = Model<FovShape>;

}  // namespace tartan_calib::camera
