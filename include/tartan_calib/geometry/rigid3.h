#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace tartan_calib::geometry {

using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

/// A rigid motion. `T_a_b` maps coordinates in frame b to frame a: `p_a = T_a_b * p_b = R_a_b p_b + t_a_b` [m].
///
/// Perturbations act from the left: `T <- exp(xi) * T` with `xi = [rho; phi]`, translation [m] before rotation [rad].
struct Rigid3 {
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();  ///< unit norm
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();

  Rigid3() = default;
  Rigid3(const Eigen::Quaterniond& R, const Eigen::Vector3d& t) : rotation(R.normalized()), translation(t) {}
  Rigid3(const Eigen::Matrix3d& R, const Eigen::Vector3d& t)
      : rotation(Eigen::Quaterniond(R).normalized()), translation(t) {}

  /// T_b_a of T_a_b.
  Rigid3 inverse() const;

  /// 4x4 homogeneous matrix, last row 0 0 0 1.
  Eigen::Matrix4d matrix() const;
};

inline Rigid3 operator*(const Rigid3& T_a_b, const Rigid3& T_b_c) {
  return Rigid3(T_a_b.rotation * T_b_c.rotation, T_a_b.rotation * T_b_c.translation + T_a_b.translation);
}

inline Eigen::Vector3d operator*(const Rigid3& T_a_b, const Eigen::Vector3d& p_b) {
  return T_a_b.rotation * p_b + T_a_b.translation;
}

/// Reads a 4x4 matrix whose rotation block is orthonormal to file precision; the nearest rotation is taken.
Rigid3 rigidFromMatrix(const Eigen::Matrix4d& matrix);

/// Skew-symmetric matrix: `hat(a) * b = a x b`.
Eigen::Matrix3d hat(const Eigen::Vector3d& v);

/// Rotation by |phi| radians about phi; exact at zero (Rodrigues).
Eigen::Quaterniond expRotation(const Eigen::Vector3d& phi);

/// Inverse of expRotation, |phi| <= pi.
Eigen::Vector3d logRotation(const Eigen::Quaterniond& R);

/// The shortest rotation that takes the direction `from` to the direction `to`; neither may be zero. Where they are
/// opposite, the axis is any that is perpendicular.
Eigen::Quaterniond rotationBetween(const Eigen::Vector3d& from, const Eigen::Vector3d& to);

/// exp(phi + d) = exp(leftJacobian(phi) * d) * exp(phi) to first order in d.
Eigen::Matrix3d leftJacobian(const Eigen::Vector3d& phi);

/// SE(3) exponential of xi = [rho; phi] (Barfoot, State Estimation for Robotics, eq. 7.85).
Rigid3 expRigid(const Vector6d& xi);

/// Inverse of expRigid.
Vector6d logRigid(const Rigid3& T);

/// exp(Ad(T) xi) = T exp(xi) T^-1.
Matrix6d adjoint(const Rigid3& T);

}  // namespace tartan_calib::geometry
