#include "information_bound.h"

#include <Eigen/LU>
#include <cmath>
#include <optional>

#include "tartan_calib/simulation/board_pattern.h"
#include "tartan_calib/simulation/sensor.h"
#include "tartan_calib/target/target.h"

namespace tartan_calib::simulation {
namespace {

constexpr double kSaturatedGrey = 254.5;

}  // namespace

InformationBound::InformationBound(const Exposure& exposure, const Scene& scene, const camera::Camera& camera,
                                   const geometry::Rigid3& T_cam_target)
    : exposure_(exposure),
      scene_(scene),
      camera_(camera),
      T_cam_target_(T_cam_target),
      corner_points_(target::cornerPoints(scene.target)),
      half_window_m_(cornerHalfWindow(scene.target)) {}

Eigen::Matrix2d InformationBound::ofCorner(const TrueCorner& corner) const {
  const Eigen::Vector3d& p_target = corner_points_[static_cast<std::size_t>(corner.corner_id)];
  Eigen::Matrix2d J_px_window;  // of target coordinates in half-windows
  for (int axis = 0; axis < 2; ++axis) {
    const Eigen::Vector3d step = half_window_m_ * Eigen::Vector3d::Unit(axis);
    const auto before = camera::project(camera_.model, T_cam_target_ * (p_target - step));
    const auto after = camera::project(camera_.model, T_cam_target_ * (p_target + step));
    if (!before || !after) {
      return kNoInformationPx2 * Eigen::Matrix2d::Identity();
    }
    J_px_window.col(axis) = 0.5 * (*after - *before);
  }
  const Eigen::Matrix2d normal = information(corner.px, J_px_window);
  return (normal + Eigen::Matrix2d::Identity() / kNoInformationPx2).inverse();
}

Eigen::Matrix2d InformationBound::information(const Eigen::Vector2d& corner_px, const Eigen::Matrix2d& J_px_window) const {
  const Eigen::Matrix2d to_window = J_px_window.inverse();
  const Eigen::Vector2d reach = J_px_window.cwiseAbs().rowwise().sum();
  const cv::Point centre(static_cast<int>(std::lround(corner_px.x())), static_cast<int>(std::lround(corner_px.y())));
  const cv::Point radius(static_cast<int>(std::ceil(reach.x())) + 1, static_cast<int>(std::ceil(reach.y())) + 1);
  const cv::Rect pixels = cv::Rect(centre - radius, centre + radius) & exposure_.board_window;
  Eigen::Matrix2d normal = Eigen::Matrix2d::Zero();
  for (int row = pixels.y; row < pixels.y + pixels.height; ++row) {
    for (int col = pixels.x; col < pixels.x + pixels.width; ++col) {
      const double light = static_cast<double>(exposure_.light(row, col));
      const Eigen::Vector2d in_window = to_window * (Eigen::Vector2d(col, row) - corner_px);
      if (light >= kSaturatedGrey || in_window.cwiseAbs().maxCoeff() > 1.0) {
        continue;
      }
      const cv::Vec2f& d = exposure_.light_derivative(row - exposure_.board_window.y, col - exposure_.board_window.x);
      const Eigen::Vector2d J(static_cast<double>(d[0]), static_cast<double>(d[1]));
      normal += J * J.transpose() / pixelVariance(light, scene_.sensor);
    }
  }
  return normal;
}

}  // namespace tartan_calib::simulation
