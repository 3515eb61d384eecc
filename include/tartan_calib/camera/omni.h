#pragma once

#include <Eigen/Core>
#include <cmath>
#include <limits>

#include "tartan_calib/camera/distortion.h"
#include "tartan_calib/camera/model.h"

namespace tartan_calib::camera {

/// Unified omnidirectional model (Mei and Rives 2007): d = |p|, m = distort((x, y) / (z + xi d)).
/// Valid for z > -s d with s = xi where xi <= 1, else 1 / xi. Parameters [xi, fu, fv, cu, cv, distortion...].
template <class Distortion>
class OmniShape {
 public:
  static constexpr const char* kKalibrModel = "omni";
  static constexpr const char* kKalibrDistortion = Distortion::kKalibrDistortion;
  static constexpr int kNumLeading = 1;
  static constexpr int kNumTrailing = Distortion::kNumParameters;
  using Parameters = Eigen::Matrix<double, 1 + kNumTrailing, 1>;

  explicit OmniShape(const Parameters& shape)
      : xi_(shape(0)), distortion_(typename Distortion::Parameters(shape.template tail<kNumTrailing>())) {}

  static Parameters start() {
    Parameters shape = Parameters::Zero();
    shape(0) = 1.0;
    return shape;
  }
  static Parameters lowerBound() {
    Parameters bound = Parameters::Constant(-std::numeric_limits<double>::infinity());
    bound(0) = 0.0;
    return bound;
  }
  static Parameters upperBound() {
    Parameters bound = Parameters::Constant(std::numeric_limits<double>::infinity());
    bound(0) = kMaxXi;
    return bound;
  }

  bool project(const Eigen::Vector3d& p, Eigen::Vector2d& m, Matrix23d* J_m_p,
               Eigen::Matrix<double, 2, 1 + kNumTrailing>* J_m_shape) const {
    const double d = p.norm();
    const double cosine_limit = xi_ <= 1.0 ? xi_ : 1.0 / xi_;
    const double denominator = p.z() + xi_ * d;
    if (!(p.z() > (kMargin - cosine_limit) * d)) {
      return false;
    }
    const double scale = 1.0 / denominator;
    const Eigen::Vector2d normalised = scale * p.head<2>();
    Eigen::Vector2d distorted = normalised;
    Eigen::Matrix2d J_distortion;
    Eigen::Matrix<double, 2, kNumTrailing> J_m_trailing;
    if (!distortion_.distort(distorted, &J_distortion, J_m_shape != nullptr ? &J_m_trailing : nullptr)) {
      return false;
    }
    m = distorted;
    if (J_m_p != nullptr) {
      const Eigen::RowVector3d J_denominator_p = Eigen::RowVector3d(0.0, 0.0, 1.0) + (xi_ / d) * p.transpose();
      Matrix23d J_normalised_p = -scale * normalised * J_denominator_p;
      J_normalised_p(0, 0) += scale;
      J_normalised_p(1, 1) += scale;
      *J_m_p = J_distortion * J_normalised_p;
    }
    if (J_m_shape != nullptr) {
      J_m_shape->col(0) = J_distortion * (-scale * d * normalised);
      J_m_shape->template rightCols<kNumTrailing>() = J_m_trailing;
    }
    return true;
  }

  bool unproject(const Eigen::Vector2d& m, Eigen::Vector3d& ray) const {
    Eigen::Vector2d normalised = m;
    if (!distortion_.undistort(normalised)) {
      return false;
    }
    const double rho2 = normalised.squaredNorm();
    const double discriminant = 1.0 + (1.0 - xi_ * xi_) * rho2;
    if (discriminant < 0.0) {
      return false;
    }
    ray << normalised, 1.0 - xi_ * (rho2 + 1.0) / (xi_ + std::sqrt(discriminant));
    return true;
  }

 private:
  static constexpr double kMaxXi = 20.0;   ///< beyond it the image is that of xi = infinity (a sphere seen from afar)
  static constexpr double kMargin = 1e-6;  ///< of the cosine, from the edge of validity

  double xi_;
  Distortion distortion_;
};

struct OmniNoneShape : OmniShape<NoDistortion> {
  static constexpr const char* kName = "omni-none";
  using OmniShape::OmniShape;
};

struct OmniRadtanShape : OmniShape<Radtan> {
  static constexpr const char* kName = "omni-radtan";
  using OmniShape::OmniShape;
};

using OmniNone = Model<OmniNoneShape>;
using OmniRadtan = Model<OmniRadtanShape>;

}  // namespace tartan_calib::camera
