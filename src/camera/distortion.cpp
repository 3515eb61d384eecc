#include "tartan_calib/camera/distortion.h"

#include <Eigen/LU>
#include <cmath>

namespace tartan_calib::camera {
namespace {

constexpr int kMaxNewtonSteps = 100;
constexpr int kBracketSteps = 60;
constexpr double kConverged = 1e-14;
constexpr double kAccepted = 1e-9;  ///< of the normalised plane: a millionth of a pixel at f = 1000

/// Smallest positive root s = r^2 of d(r g)/dr = 1 + 3 k1 s + 5 k2 s^2, infinite where there is none.
double squaredFoldRadius(double k1, double k2) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const double a = 5.0 * k2;
  const double b = 3.0 * k1;
  const double discriminant = b * b - 4.0 * a;
  if (discriminant < 0.0) {
    return kInfinity;
  }
  // Roots 2 / (-b +- sqrt(D)): the stable form, also for a = 0; the larger denominator gives the smaller positive root.
  const double denominator = -b + std::sqrt(discriminant);
  return denominator > 0.0 ? 2.0 / denominator : kInfinity;
}

}  // namespace

Radtan::Radtan(const Parameters& parameters) : k_(parameters), max_r2_(squaredFoldRadius(parameters(0), parameters(1))) {}

Eigen::Vector2d Radtan::value(const Eigen::Vector2d& m) const {
  const double r2 = m.squaredNorm();
  const double radial = 1.0 + r2 * (k_(0) + r2 * k_(1));
  const double xy = m.x() * m.y();
  return {m.x() * radial + 2.0 * k_(2) * xy + k_(3) * (r2 + 2.0 * m.x() * m.x()),
          m.y() * radial + 2.0 * k_(3) * xy + k_(2) * (r2 + 2.0 * m.y() * m.y())};
}

Eigen::Matrix2d Radtan::jacobian(const Eigen::Vector2d& m) const {
  const double r2 = m.squaredNorm();
  const double radial = 1.0 + r2 * (k_(0) + r2 * k_(1));
  const double slope = 2.0 * (k_(0) + 2.0 * r2 * k_(1));  // d(radial)/d(r2) * 2
  const double mixed = slope * m.x() * m.y() + 2.0 * (k_(2) * m.x() + k_(3) * m.y());
  Eigen::Matrix2d J;
  J << radial + slope * m.x() * m.x() + 2.0 * k_(2) * m.y() + 6.0 * k_(3) * m.x(), mixed, mixed,
      radial + slope * m.y() * m.y() + 2.0 * k_(3) * m.x() + 6.0 * k_(2) * m.y();
  return J;
}

bool Radtan::distort(Eigen::Vector2d& m, Eigen::Matrix2d* J_m, Eigen::Matrix<double, 2, 4>* J_parameters) const {
  const double r2 = m.squaredNorm();
  const Eigen::Matrix2d J = jacobian(m);
  if (!(r2 < max_r2_) || !(J.determinant() > 0.0)) {
    return false;
  }
  if (J_m != nullptr) {
    *J_m = J;
  }
  if (J_parameters != nullptr) {
    const double xy = 2.0 * m.x() * m.y();
    *J_parameters << m.x() * r2, m.x() * r2 * r2, xy, r2 + 2.0 * m.x() * m.x(),  //
        m.y() * r2, m.y() * r2 * r2, r2 + 2.0 * m.y() * m.y(), xy;
  }
  m = value(m);
  return true;
}

bool Radtan::undistort(Eigen::Vector2d& m) const {
  const Eigen::Vector2d wanted = m;
  const double wanted_radius = wanted.norm();
  if (wanted_radius == 0.0) {
    return true;
  }
  // Radial part first, by bisection on the monotone branch: near the fold Newton from the distorted point runs off.
  const auto distorted_radius = [this](double r) { return r * (1.0 + r * r * (k_(0) + r * r * k_(1))); };
  double low = 0.0;
  double high = std::sqrt(max_r2_);
  if (!std::isfinite(high)) {
    for (high = wanted_radius; distorted_radius(high) < wanted_radius && high < 1e6 * wanted_radius;) {
      high *= 2.0;
    }
  }
  for (int i = 0; i < kBracketSteps; ++i) {
    const double middle = 0.5 * (low + high);
    (distorted_radius(middle) < wanted_radius ? low : high) = middle;
  }
  // Then both axes, damped so that the error falls.
  Eigen::Vector2d estimate = wanted * (0.5 * (low + high) / wanted_radius);
  double error = (value(estimate) - wanted).norm();
  for (int i = 0; i < kMaxNewtonSteps && error > kConverged; ++i) {
    Eigen::Vector2d step = jacobian(estimate).inverse() * (wanted - value(estimate));
    Eigen::Vector2d next = estimate + step;
    for (int halving = 0; halving < 30 && !((value(next) - wanted).norm() < error); ++halving) {
      step *= 0.5;
      next = estimate + step;
    }
    const double next_error = (value(next) - wanted).norm();
    if (!(next_error < error)) {
      break;
    }
    estimate = next;
    error = next_error;
  }
  if (!(error < kAccepted * (1.0 + wanted_radius)) || !(estimate.squaredNorm() < max_r2_) ||
      !(jacobian(estimate).determinant() > 0.0)) {
    return false;
  }
  m = estimate;
  return true;
}

}  // namespace tartan_calib::camera
