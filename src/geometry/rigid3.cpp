#include "tartan_calib/geometry/rigid3.h"

#include <Eigen/SVD>
#include <cmath>

namespace tartan_calib::geometry {
namespace {

/// Below this angle the closed forms lose digits to cancellation; the series' next term is below 1e-16 relative.
constexpr double kSmallAngle_rad = 1e-4;

}  // namespace

Rigid3 Rigid3::inverse() const {
  const Eigen::Quaterniond R_b_a = rotation.conjugate();
  return Rigid3(R_b_a, -(R_b_a * translation));
}

Eigen::Matrix4d Rigid3::matrix() const {
  Eigen::Matrix4d m = Eigen::Matrix4d::Identity();
  m.topLeftCorner<3, 3>() = rotation.toRotationMatrix();
  m.topRightCorner<3, 1>() = translation;
  return m;
}

Rigid3 rigidFromMatrix(const Eigen::Matrix4d& matrix) {
  const Eigen::Matrix3d block = matrix.topLeftCorner<3, 3>();
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(block, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Matrix3d nearest = svd.matrixU() * svd.matrixV().transpose();
  if (nearest.determinant() < 0.0) {
    nearest = svd.matrixU() * Eigen::Vector3d(1.0, 1.0, -1.0).asDiagonal() * svd.matrixV().transpose();
  }
  return Rigid3(nearest, Eigen::Vector3d(matrix.topRightCorner<3, 1>()));
}

Eigen::Matrix3d hat(const Eigen::Vector3d& v) {
  Eigen::Matrix3d m;
  m << 0.0, -v.z(), v.y(), v.z(), 0.0, -v.x(), -v.y(), v.x(), 0.0;
  return m;
}

Eigen::Quaterniond expRotation(const Eigen::Vector3d& phi) {
  const double angle = phi.norm();
  const double half = 0.5 * angle;
  const double sinc_half = angle < kSmallAngle_rad ? 0.5 - angle * angle / 48.0 : std::sin(half) / angle;
  const Eigen::Vector3d xyz = sinc_half * phi;
  return Eigen::Quaterniond(std::cos(half), xyz.x(), xyz.y(), xyz.z()).normalized();
}

Eigen::Vector3d logRotation(const Eigen::Quaterniond& R) {
  // q and -q are the same rotation; the one with w >= 0 has the angle within pi.
  const double sign = R.w() < 0.0 ? -1.0 : 1.0;
  const double w = sign * R.w();
  const Eigen::Vector3d xyz = sign * R.vec();
  const double sine = xyz.norm();
  if (sine < kSmallAngle_rad) {
    return (2.0 / w) * (1.0 - sine * sine / (3.0 * w * w)) * xyz;
  }
  return (2.0 * std::atan2(sine, w) / sine) * xyz;
}

Eigen::Quaterniond rotationBetween(const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  constexpr double kOpposite = 1e-8;  // twice the cosine of half the angle: the product of the directions is rounding
  const Eigen::Vector3d a = from.normalized();
  const Eigen::Vector3d b = to.normalized();
  const double length = (a + b).norm();
  if (length < kOpposite) {
    const Eigen::Vector3d axis = a.unitOrthogonal();
    return Eigen::Quaterniond(0.0, axis.x(), axis.y(), axis.z());
  }
  const Eigen::Vector3d v = a.cross(b) / length;
  return Eigen::Quaterniond(0.5 * length, v.x(), v.y(), v.z()).normalized();
}

Eigen::Matrix3d leftJacobian(const Eigen::Vector3d& phi) {
  const double angle = phi.norm();
  const double angle2 = angle * angle;
  double a = 0.5 - angle2 / 24.0;
  double b = 1.0 / 6.0 - angle2 / 120.0;
  if (angle >= kSmallAngle_rad) {
    const double sine_half = std::sin(0.5 * angle);
    a = 2.0 * sine_half * sine_half / angle2;
    b = (angle - std::sin(angle)) / (angle2 * angle);
  }
  const Eigen::Matrix3d skew = hat(phi);
  return Eigen::Matrix3d::Identity() + a * skew + b * skew * skew;
}

Rigid3 expRigid(const Vector6d& xi) {
  const Eigen::Vector3d phi = xi.tail<3>();
  return Rigid3(expRotation(phi), leftJacobian(phi) * xi.head<3>());
}

Vector6d logRigid(const Rigid3& T) {
  const Eigen::Vector3d phi = logRotation(T.rotation);
  Vector6d xi;
  xi << leftJacobian(phi).inverse() * T.translation, phi;
  return xi;
}

Matrix6d adjoint(const Rigid3& T) {
  const Eigen::Matrix3d R = T.rotation.toRotationMatrix();
  Matrix6d ad = Matrix6d::Zero();
  ad.topLeftCorner<3, 3>() = R;
  ad.topRightCorner<3, 3>() = hat(T.translation) * R;
  ad.bottomRightCorner<3, 3>() = R;
  return ad;
}

}  // namespace tartan_calib::geometry
