#include "tartan_calib/report/uncertainty.h"

#include <cmath>

#include "tartan_calib/calibration/intrinsics_uncertainty.h"
#include "tartan_calib/geometry/linear_solve.h"

namespace tartan_calib::report {
namespace {

/// First-order change of a pixel with the camera's parameters and with a rotation of its frame.
struct PixelChange {
  camera::ParameterJacobian J_px_parameters;
  Eigen::Matrix<double, 2, 3> J_px_rotation;
};

std::optional<PixelChange> pixelChange(const camera::CameraModel& model, const Eigen::Vector2d& px) {
  const auto ray = camera::unproject(model, px);
  camera::Matrix23d J_px_ray;
  camera::ParameterJacobian J_px_parameters;
  if (!ray || !camera::project(model, *ray, &J_px_ray, &J_px_parameters)) {
    return std::nullopt;
  }
  return PixelChange{J_px_parameters, -J_px_ray * geometry::hat(*ray)};
}

/// The rotation that takes up a change of the parameters best over the pixels: rotation = K * change.
Eigen::Matrix<double, 3, Eigen::Dynamic> alignment(const camera::CameraModel& model,
                                                   const std::vector<Eigen::Vector2d>& aligned_px) {
  Eigen::MatrixXd H = Eigen::MatrixXd::Zero(3, 3);
  Eigen::MatrixXd coupling = Eigen::MatrixXd::Zero(3, camera::numParameters(model));
  for (const Eigen::Vector2d& px : aligned_px) {
    if (const auto change = pixelChange(model, px)) {
      H += change->J_px_rotation.transpose() * change->J_px_rotation;
      coupling += change->J_px_rotation.transpose() * change->J_px_parameters;
    }
  }
  return -geometry::solveSymmetric(H, coupling);
}

/// The root of the larger eigenvalue.
double largestStdev(const Eigen::Matrix2d& covariance) {
  const double half_difference = 0.5 * (covariance(0, 0) - covariance(1, 1));
  return std::sqrt(0.5 * covariance.trace() + std::hypot(half_difference, covariance(0, 1)));
}

}  // namespace

std::vector<std::optional<double>> projectionStdevs(const calibration::Solution& solution, int camera_index,
                                                    const std::vector<Eigen::Vector2d>& aligned_px,
                                                    const std::vector<Eigen::Vector2d>& samples_px) {
  const camera::CameraModel& model = solution.rig.cameras[static_cast<std::size_t>(camera_index)].camera.model;
  const Eigen::MatrixXd covariance = calibration::intrinsicsCovariance(solution, camera_index);
  const Eigen::Matrix<double, 3, Eigen::Dynamic> K = alignment(model, aligned_px);
  std::vector<std::optional<double>> stdevs_px;
  for (const Eigen::Vector2d& px : samples_px) {
    const auto change = pixelChange(model, px);
    stdevs_px.emplace_back();
    if (change) {
      const Eigen::Matrix<double, 2, Eigen::Dynamic> J = change->J_px_parameters + change->J_px_rotation * K;
      stdevs_px.back() = largestStdev(J * covariance * J.transpose());
    }
  }
  return stdevs_px;
}

}  // namespace tartan_calib::report
