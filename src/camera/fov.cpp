#include "tartan_calib/camera/fov.h"

namespace tartan_calib::camera {
namespace {

/// Directions within a micro-radian of straight behind have no azimuth.
constexpr double kMinSine = 1e-6;

}  // namespace

bool FovShape::project(const Eigen::Vector3d& p, Eigen::Vector2d& m, Matrix23d* J_m_p,
                       Eigen::Matrix<double, 2, 1>* J_m_shape) const {
  const double rho = p.head<2>().norm();
  const double norm2 = slope_ * slope_ * rho * rho + p.z() * p.z();
  const bool behind = p.z() <= 0.0 && rho <= kMinSine * -p.z();
  if (behind || !(norm2 > 0.0)) {
    return false;
  }
  // scale = radius / rho; near the axis its limit, where every derivative of it vanishes or is multiplied by rho.
  const bool on_axis = rho < kMinSine * p.z();
  const double angle = std::atan2(slope_ * rho, p.z());
  const double scale = on_axis ? slope_ / (w_ * p.z()) : angle / (w_ * rho);
  m = scale * p.head<2>();
  if (J_m_p != nullptr) {
    const double J_radius_rho = slope_ * p.z() / (w_ * norm2);
    const Eigen::Vector2d unit = on_axis ? Eigen::Vector2d::Zero() : Eigen::Vector2d(p.head<2>() / rho);
    J_m_p->leftCols<2>() = scale * Eigen::Matrix2d::Identity() + (J_radius_rho - scale) * unit * unit.transpose();
    J_m_p->col(2) = -slope_ / (w_ * norm2) * p.head<2>();
  }
  if (J_m_shape != nullptr) {
    const double J_slope_w = 1.0 + 0.25 * slope_ * slope_;
    *J_m_shape = (p.z() / norm2 * J_slope_w - scale) / w_ * p.head<2>();
  }
  return true;
}

bool FovShape::unproject(const Eigen::Vector2d& m, Eigen::Vector3d& ray) const {
  const double radius = m.norm();
  const double angle = radius * w_;
  if (!(angle < M_PI)) {
    return false;
  }
  // rho : z = sin(angle) / slope : cos(angle); rho / radius stays finite on the axis.
  const double sine_over_radius = radius < kMinSine ? w_ : std::sin(angle) / radius;
  ray << sine_over_radius / slope_ * m, std::cos(angle);
  return true;
}

}  // namespace tartan_calib::camera
