#include "tartan_calib/calibration/intrinsics_uncertainty.h"

#include <algorithm>
#include <cmath>

namespace tartan_calib::calibration {

Eigen::MatrixXd intrinsicsCovariance(const Solution& solution, int camera_index) {
  const int row = intrinsicsRow(solution.rig, camera_index);
  const int count = camera::numParameters(solution.rig.cameras[static_cast<std::size_t>(camera_index)].camera.model);
  return solution.covariance.block(row, row, count, count);
}

double focalStdevRatio(const Solution& solution, int camera_index) {
  constexpr double kOffAxis_rad = 1e-3;  // small against the lens, large against rounding
  const camera::CameraModel& model = solution.rig.cameras[static_cast<std::size_t>(camera_index)].camera.model;
  camera::ParameterJacobian J_left;
  camera::ParameterJacobian J_right;
  const auto left_px = camera::project(model, {-std::sin(kOffAxis_rad), 0.0, std::cos(kOffAxis_rad)}, nullptr, &J_left);
  const auto right_px = camera::project(model, {std::sin(kOffAxis_rad), 0.0, std::cos(kOffAxis_rad)}, nullptr, &J_right);
  const double width_px = right_px->x() - left_px->x();
  const Eigen::VectorXd gradient = (J_right.row(0) - J_left.row(0)).transpose();
  return std::sqrt(std::max(0.0, gradient.dot(intrinsicsCovariance(solution, camera_index) * gradient))) / width_px;
}

}  // namespace tartan_calib::calibration
