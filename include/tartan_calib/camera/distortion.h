#pragma once

#include <Eigen/Core>
#include <limits>

namespace tartan_calib::camera {

/// Distortions of the normalised plane, m_distorted = distort(m). Each has kKalibrDistortion, kNumParameters, Parameters,
/// `distort(m, J_m, J_parameters)` (false beyond the fold) and `undistort(m_distorted, m)` (false where there is no m).

struct NoDistortion {
  static constexpr const char* kKalibrDistortion = "none";
  static constexpr int kNumParameters = 0;
  using Parameters = Eigen::Matrix<double, 0, 1>;

  explicit NoDistortion(const Parameters& /*parameters*/) {}

  bool distort(Eigen::Vector2d& /*m*/, Eigen::Matrix2d* J_m, Eigen::Matrix<double, 2, 0>* /*J_parameters*/) const {
    if (J_m != nullptr) {
      J_m->setIdentity();
    }
    return true;
  }
  bool undistort(Eigen::Vector2d& /*m*/) const { return true; }
};

/// Radial-tangential distortion [k1, k2, p1, p2] (Brown 1971, as OpenCV's first four coefficients):
///   r2 = x^2 + y^2,  g = 1 + k1 r2 + k2 r2^2
///   x' = x g + 2 p1 x y + p2 (r2 + 2 x^2)
///   y' = y g + 2 p2 x y + p1 (r2 + 2 y^2)
/// Valid where the map is still one to one: within the radius at which r g(r) stops growing, and det(J) > 0.
class Radtan {
 public:
  static constexpr const char* kKalibrDistortion = "radtan";
  static constexpr int kNumParameters = 4;
  using Parameters = Eigen::Vector4d;

  explicit Radtan(const Parameters& parameters);

  /// In place.
  bool distort(Eigen::Vector2d& m, Eigen::Matrix2d* J_m, Eigen::Matrix<double, 2, 4>* J_parameters) const;
  bool undistort(Eigen::Vector2d& m) const;

 private:
  Eigen::Vector2d value(const Eigen::Vector2d& m) const;
  Eigen::Matrix2d jacobian(const Eigen::Vector2d& m) const;

  Parameters k_;
  double max_r2_;  ///< squared radius of the fold, infinite where there is none
};

}  // namespace tartan_calib::camera
