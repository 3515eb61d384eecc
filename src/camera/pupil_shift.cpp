#include "tartan_calib/camera/pupil_shift.h"

#include <cmath>

namespace tartan_calib::camera {

double PupilShift::at_m(double polar_angle_rad) const {
  const double squared = polar_angle_rad * polar_angle_rad;
  return (coefficients_m.x() + coefficients_m.y() * squared) * squared;
}

Eigen::Vector3d PupilShift::apply(const Eigen::Vector3d& p_cam, Eigen::Matrix3d* J_p, Jacobian* J_coefficients) const {
  const double radius = p_cam.head<2>().norm();
  const double angle = std::atan2(radius, p_cam.z());
  const double squared = angle * angle;
  if (J_p != nullptr) {
    J_p->setIdentity();
    if (radius > 0.0) {
      // d(angle) = (z d(radius) - radius d(z)) / |p|^2; on the axis the shift has no slope.
      const double slope = 2.0 * angle * (coefficients_m.x() + 2.0 * coefficients_m.y() * squared) / p_cam.squaredNorm();
      J_p->row(2).head<2>() = -slope * p_cam.z() / radius * p_cam.head<2>().transpose();
      (*J_p)(2, 2) += slope * radius;
    }
  }
  if (J_coefficients != nullptr) {
    J_coefficients->setZero();
    J_coefficients->row(2) << -squared, -squared * squared;
  }
  return p_cam - at_m(angle) * Eigen::Vector3d::UnitZ();
}

}  // namespace tartan_calib::camera
