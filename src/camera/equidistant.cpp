#include "tartan_calib/camera/equidistant.h"

#include <algorithm>
#include <cmath>

namespace tartan_calib::camera {
namespace {

constexpr double kMinSine = 1e-9;  ///< closer to the axis the azimuth means nothing
constexpr int kFoldScanSteps = 256;
constexpr int kBisections = 60;
constexpr int kMaxNewtonSteps = 50;

}  // namespace

EquidistantShape::EquidistantShape(const Parameters& k) : k_(k), max_theta_rad_(M_PI), max_theta_d_rad_(0.0) {
  for (int step = 1; step <= kFoldScanSteps; ++step) {
    double outside = M_PI * step / kFoldScanSteps;
    if (slope(outside) > 0.0) {
      continue;
    }
    double inside = M_PI * (step - 1) / kFoldScanSteps;
    for (int i = 0; i < kBisections; ++i) {
      const double middle = 0.5 * (inside + outside);
      (slope(middle) > 0.0 ? inside : outside) = middle;
    }
    max_theta_rad_ = inside;
    break;
  }
  max_theta_d_rad_ = distortedAngle(max_theta_rad_);
}

double EquidistantShape::distortedAngle(double theta_rad) const {
  const double t2 = theta_rad * theta_rad;
  return theta_rad * (1.0 + t2 * (k_(0) + t2 * (k_(1) + t2 * (k_(2) + t2 * k_(3)))));
}

double EquidistantShape::slope(double theta_rad) const {
  const double t2 = theta_rad * theta_rad;
  return 1.0 + t2 * (3.0 * k_(0) + t2 * (5.0 * k_(1) + t2 * (7.0 * k_(2) + t2 * 9.0 * k_(3))));
}

bool EquidistantShape::project(const Eigen::Vector3d& p, Eigen::Vector2d& m, Matrix23d* J_m_p,
                               Eigen::Matrix<double, 2, 4>* J_m_shape) const {
  const double rho = p.head<2>().norm();
  const double theta = std::atan2(rho, p.z());
  const bool on_axis = rho < kMinSine * p.z();
  if (!(theta < max_theta_rad_) || (rho <= kMinSine * -p.z())) {
    return false;
  }
  const Eigen::Vector2d unit = on_axis ? Eigen::Vector2d::Zero() : Eigen::Vector2d(p.head<2>() / rho);
  const double scale = on_axis ? 1.0 / p.z() : distortedAngle(theta) / rho;
  m = scale * p.head<2>();
  if (J_m_p != nullptr) {
    const double radial = slope(theta) / p.squaredNorm();
    J_m_p->leftCols<2>() = scale * Eigen::Matrix2d::Identity() + (radial * p.z() - scale) * unit * unit.transpose();
    J_m_p->col(2) = -radial * p.head<2>();
  }
  if (J_m_shape != nullptr) {
    double power = theta;
    for (int i = 0; i < 4; ++i) {
      power *= theta * theta;
      J_m_shape->col(i) = power * unit;
    }
  }
  return true;
}

bool EquidistantShape::unproject(const Eigen::Vector2d& m, Eigen::Vector3d& ray) const {
  const double theta_d = m.norm();
  if (!(theta_d < max_theta_d_rad_)) {
    return false;
  }
  // Newton, kept inside a bracket: theta_d grows over the whole of [0, max_theta].
  double low = 0.0;
  double high = max_theta_rad_;
  double theta = std::min(theta_d, 0.5 * (low + high));
  for (int i = 0; i < kMaxNewtonSteps; ++i) {
    const double error = distortedAngle(theta) - theta_d;
    (error > 0.0 ? high : low) = theta;
    double next = theta - error / slope(theta);
    if (!(next >= low && next <= high)) {
      next = 0.5 * (low + high);
    }
    const double moved = std::abs(next - theta);
    theta = next;
    if (moved < 1e-15) {
      break;
    }
  }
  const Eigen::Vector2d unit = theta_d > 0.0 ? Eigen::Vector2d(m / theta_d) : Eigen::Vector2d::Zero();
  ray << std::sin(theta) * unit, std::cos(theta);
  return true;
}

}  // namespace tartan_calib::camera
