#include "tartan_calib/camera/double_sphere.h"

#include <cmath>

namespace tartan_calib::camera {
namespace {

/// Of the cosine, from the edge of validity, where the image runs to infinity or turns back.
constexpr double kMargin = 1e-6;

}  // namespace

DoubleSphereShape::DoubleSphereShape(const Parameters& shape) : xi_(shape(0)), alpha_(shape(1)) {
  const double w1 = alpha_ <= 0.5 ? alpha_ / (1.0 - alpha_) : (1.0 - alpha_) / alpha_;
  min_cosine_ = -(w1 + xi_) / std::sqrt(2.0 * w1 * xi_ + xi_ * xi_ + 1.0);
}

bool DoubleSphereShape::project(const Eigen::Vector3d& p, Eigen::Vector2d& m, Matrix23d* J_m_p,
                                Eigen::Matrix2d* J_m_shape) const {
  const double d1 = p.norm();
  if (!(p.z() > (min_cosine_ + kMargin) * d1)) {
    return false;
  }
  const double k = xi_ * d1 + p.z();
  const double d2 = std::sqrt(p.head<2>().squaredNorm() + k * k);
  const double denominator = alpha_ * d2 + (1.0 - alpha_) * k;
  if (!(denominator > 0.0)) {
    return false;
  }
  const double scale = 1.0 / denominator;
  m = scale * p.head<2>();
  const double J_denominator_k = alpha_ * k / d2 + 1.0 - alpha_;
  if (J_m_p != nullptr) {
    const Eigen::RowVector3d J_k_p = Eigen::RowVector3d(0.0, 0.0, 1.0) + (xi_ / d1) * p.transpose();
    const Eigen::RowVector3d J_denominator_p =
        (alpha_ / d2) * Eigen::RowVector3d(p.x(), p.y(), 0.0) + J_denominator_k * J_k_p;
    *J_m_p = -scale * m * J_denominator_p;
    (*J_m_p)(0, 0) += scale;
    (*J_m_p)(1, 1) += scale;
  }
  if (J_m_shape != nullptr) {
    J_m_shape->col(0) = -scale * J_denominator_k * d1 * m;
    J_m_shape->col(1) = -scale * (d2 - k) * m;
  }
  return true;
}

bool DoubleSphereShape::unproject(const Eigen::Vector2d& m, Eigen::Vector3d& ray) const {
  const double r2 = m.squaredNorm();
  const double discriminant = 1.0 - (2.0 * alpha_ - 1.0) * r2;
  if (discriminant < 0.0) {
    return false;
  }
  const double mz = (1.0 - alpha_ * alpha_ * r2) / (alpha_ * std::sqrt(discriminant) + 1.0 - alpha_);
  const double radicand = mz * mz + (1.0 - xi_ * xi_) * r2;
  if (radicand < 0.0) {
    return false;
  }
  const double q = (mz * xi_ + std::sqrt(radicand)) / (mz * mz + r2);
  ray << q * m, q * mz - xi_;
  return true;
}

}  // namespace tartan_calib::camera
