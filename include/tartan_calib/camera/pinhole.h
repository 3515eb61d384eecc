#pragma once

#include <Eigen/Core>
#include <limits>

#include "tartan_calib/camera/distortion.h"
#include "tartan_calib/camera/model.h"

namespace tartan_calib::camera {

/// Perspective projection, m = distort((x/z, y/z)), valid for z > 0.
/// Parameters [fu, fv, cu, cv, distortion...].
template <class Distortion>
class PinholeShape {
 public:
  static constexpr const char* kKalibrModel = "pinhole";
  static constexpr const char* kKalibrDistortion = Distortion::kKalibrDistortion;
  static constexpr int kNumLeading = 0;
  static constexpr int kNumTrailing = Distortion::kNumParameters;
  using Parameters = Eigen::Matrix<double, kNumTrailing, 1>;

  explicit PinholeShape(const Parameters& distortion) : distortion_(distortion) {}

  static Parameters start() { return Parameters::Zero(); }
  static Parameters lowerBound() { return Parameters::Constant(-std::numeric_limits<double>::infinity()); }
  static Parameters upperBound() { return Parameters::Constant(std::numeric_limits<double>::infinity()); }

  bool project(const Eigen::Vector3d& p, Eigen::Vector2d& m, Matrix23d* J_m_p,
               Eigen::Matrix<double, 2, kNumTrailing>* J_m_shape) const {
    if (!(p.z() > kMinCosine * p.norm())) {
      return false;
    }
    const double inverse_z = 1.0 / p.z();
    Eigen::Vector2d distorted = p.head<2>() * inverse_z;
    Matrix23d J_normalised_p;
    J_normalised_p << inverse_z, 0.0, -distorted.x() * inverse_z, 0.0, inverse_z, -distorted.y() * inverse_z;
    Eigen::Matrix2d J_distortion;
    if (!distortion_.distort(distorted, J_m_p != nullptr ? &J_distortion : nullptr, J_m_shape)) {
      return false;
    }
    m = distorted;
    if (J_m_p != nullptr) {
      *J_m_p = J_distortion * J_normalised_p;
    }
    return true;
  }

  bool unproject(const Eigen::Vector2d& m, Eigen::Vector3d& ray) const {
    Eigen::Vector2d normalised = m;
    if (!distortion_.undistort(normalised)) {
      return false;
    }
    ray << normalised, 1.0;
    return true;
  }

 private:
  /// Directions within a micro-radian of 90 degrees have no finite image.
  static constexpr double kMinCosine = 1e-6;

  Distortion distortion_;
};

struct PinholeNoneShape : PinholeShape<NoDistortion> {
  static constexpr const char* kName = "pinhole-none";
  using PinholeShape::PinholeShape;
};

struct PinholeRadtanShape : PinholeShape<Radtan> {
  static constexpr const char* kName = "pinhole-radtan";
  using PinholeShape::PinholeShape;
};

using PinholeNone = Model<PinholeNoneShape>;
using PinholeRadtan = Model<PinholeRadtanShape>;

}  // namespace tartan_calib::camera
