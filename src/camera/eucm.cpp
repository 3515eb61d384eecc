#include "tartan_calib/camera/eucm.h"

#include <cmath>

namespace tartan_calib::camera {
namespace {

/// Relative to d, from the edge of validity, where the image runs to infinity or turns back.
constexpr double kMargin = 1e-6;

}  // namespace

bool EucmShape::project(const Eigen::Vector3d& p, Eigen::Vector2d& m, Matrix23d* J_m_p, Eigen::Matrix2d* J_m_shape) const {
  const double rho2 = p.head<2>().squaredNorm();
  const double d = std::sqrt(beta_ * rho2 + p.z() * p.z());
  const double w = alpha_ <= 0.5 ? alpha_ / (1.0 - alpha_) : (1.0 - alpha_) / alpha_;
  const double denominator = alpha_ * d + (1.0 - alpha_) * p.z();
  if (!(p.z() > (kMargin - w) * d) || !(denominator > 0.0)) {
    return false;
  }
  const double scale = 1.0 / denominator;
  m = scale * p.head<2>();
  if (J_m_p != nullptr) {
    const Eigen::RowVector3d J_denominator_p(alpha_ * beta_ * p.x() / d, alpha_ * beta_ * p.y() / d,
                                             alpha_ * p.z() / d + 1.0 - alpha_);
    *J_m_p = -scale * m * J_denominator_p;
    (*J_m_p)(0, 0) += scale;
    (*J_m_p)(1, 1) += scale;
  }
  if (J_m_shape != nullptr) {
    J_m_shape->col(0) = -scale * (d - p.z()) * m;
    J_m_shape->col(1) = -scale * (0.5 * alpha_ * rho2 / d) * m;
  }
  return true;
}

bool EucmShape::unproject(const Eigen::Vector2d& m, Eigen::Vector3d& ray) const {
  const double r2 = m.squaredNorm();
  const double discriminant = 1.0 - (2.0 * alpha_ - 1.0) * beta_ * r2;
  if (discriminant < 0.0) {
    return false;
  }
  ray << m, (1.0 - alpha_ * alpha_ * beta_ * r2) / (alpha_ * std::sqrt(discriminant) + 1.0 - alpha_);
  return true;
}

}  // namespace tartan_calib::camera
