#pragma once

#include <Eigen/Core>

#include "tartan_calib/camera/model.h"

namespace tartan_calib::camera {

/// How the entrance pupil of a wide lens moves along its axis with the polar angle theta of the incoming ray:
///
///   p_lens = p_cam - (a theta^2 + b theta^4) e_z,   theta = angle between p_cam and the axis
///
/// The central model then takes p_lens. Millimetres of it matter for boards within decimetres and vanish for far points, for
/// which the central model alone holds. The idea of a moving pupil is Gennery's (Generalized camera calibration including
/// fish-eye lenses, IJCV 68, 2006); theta here is the point's own angle, so that the shift is explicit.
struct PupilShift {
  static constexpr int kNumParameters = 2;
  using Jacobian = Eigen::Matrix<double, 3, kNumParameters>;

  Eigen::Vector2d coefficients_m = Eigen::Vector2d::Zero();  ///< a [m / rad^2], b [m / rad^4]

  bool isZero() const { return coefficients_m.isZero(0.0); }

  /// How far the pupil of rays at that polar angle lies before the one of the axis [m].
  double at_m(double polar_angle_rad) const;

  /// p_lens of p_cam; J_p = d(p_lens) / d(p_cam), J_coefficients = d(p_lens) / d(coefficients_m).
  Eigen::Vector3d apply(const Eigen::Vector3d& p_cam, Eigen::Matrix3d* J_p = nullptr,
                        Jacobian* J_coefficients = nullptr) const;
};

}  // namespace tartan_calib::camera
