#include "tartan_calib/report/uncertainty.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <cmath>

#include "tartan_calib/geometry/rigid3.h"

namespace tartan_calib::report {
namespace {

constexpr double kOffAxis_rad = 1e-3;  ///< small against the lens, large against rounding

/// First-order change of a pixel with the camera's parameters and with a rotation of its frame.
struct PixelChange {
  Eigen::Matrix<double, 2, Eigen::Dynamic> J_px_parameters;
  Eigen::Matrix<double, 2, 3> J_px_rotation;
};

template <class Model>
std::optional<PixelChange> pixelChange(const Model& model, const Eigen::Vector2d& px) {
  Eigen::Vector3d ray;
  Eigen::Vector2d projected_px;
  camera::Matrix23d J_px_ray;
  typename Model::ParameterJacobian J_px_parameters;
  if (!model.unproject(px, ray) || !model.project(ray, projected_px, &J_px_ray, &J_px_parameters)) {
    return std::nullopt;
  }
  return PixelChange{J_px_parameters, -J_px_ray * geometry::hat(ray)};
}

std::optional<PixelChange> pixelChange(const camera::CameraModel& model, const Eigen::Vector2d& px) {
  return std::visit([&](const auto& visited) { return pixelChange(visited, px); }, model);
}

Eigen::MatrixXd parameterCovariance(const calibration::Solution& solution, int camera_index) {
  const int row = calibration::intrinsicsRow(solution.rig, camera_index);
  const int count = camera::numParameters(solution.rig.cameras[static_cast<std::size_t>(camera_index)].camera.model);
  return solution.covariance.block(row, row, count, count);
}

/// The rotation that takes up a change of the parameters best over the pixels: rotation = K * change.
Eigen::Matrix<double, 3, Eigen::Dynamic> alignment(const camera::CameraModel& model,
                                                   const std::vector<Eigen::Vector2d>& aligned_px) {
  Eigen::Matrix3d H = Eigen::Matrix3d::Zero();
  Eigen::Matrix<double, 3, Eigen::Dynamic> coupling(3, camera::numParameters(model));
  coupling.setZero();
  for (const Eigen::Vector2d& px : aligned_px) {
    if (const auto change = pixelChange(model, px)) {
      H += change->J_px_rotation.transpose() * change->J_px_rotation;
      coupling += change->J_px_rotation.transpose() * change->J_px_parameters;
    }
  }
  return -H.ldlt().solve(coupling);
}

double largestStdev(const Eigen::Matrix2d& covariance) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> eigen(covariance, Eigen::EigenvaluesOnly);
  return std::sqrt(std::max(0.0, eigen.eigenvalues()(1)));
}

}  // namespace

std::vector<std::optional<double>> projectionStdevs(const calibration::Solution& solution, int camera_index,
                                                    const std::vector<Eigen::Vector2d>& aligned_px,
                                                    const std::vector<Eigen::Vector2d>& samples_px) {
  const camera::CameraModel& model = solution.rig.cameras[static_cast<std::size_t>(camera_index)].camera.model;
  const Eigen::MatrixXd covariance = parameterCovariance(solution, camera_index);
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

double focalStdevRatio(const calibration::Solution& solution, int camera_index) {
  const camera::CameraModel& model = solution.rig.cameras[static_cast<std::size_t>(camera_index)].camera.model;
  const auto difference = [](const auto& visited) -> std::pair<double, Eigen::VectorXd> {
    using Model = std::decay_t<decltype(visited)>;
    Eigen::Vector2d left_px;
    Eigen::Vector2d right_px;
    typename Model::ParameterJacobian J_left;
    typename Model::ParameterJacobian J_right;
    visited.project({-std::sin(kOffAxis_rad), 0.0, std::cos(kOffAxis_rad)}, left_px, nullptr, &J_left);
    visited.project({std::sin(kOffAxis_rad), 0.0, std::cos(kOffAxis_rad)}, right_px, nullptr, &J_right);
    return {right_px.x() - left_px.x(), (J_right.row(0) - J_left.row(0)).transpose()};
  };
  const auto [width_px, gradient] = std::visit(difference, model);
  return std::sqrt(std::max(0.0, gradient.dot(parameterCovariance(solution, camera_index) * gradient))) / width_px;
}

}  // namespace tartan_calib::report
