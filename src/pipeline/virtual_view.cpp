#include "tartan_calib/pipeline/virtual_view.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace tartan_calib::pipeline {
namespace {

constexpr double kPi = 3.14159265358979323846;

/// Share of a rectified view that the board fills: from 20 to 80 %.
constexpr double kRectifiedShare = 0.6;

/// Outside of any image, and small enough for the fixed-point numbers of cv::convertMaps.
constexpr float kNowhere_px = -100.0F;

Eigen::Matrix3d rotation(double angle_rad, const Eigen::Vector3d& axis) {
  return Eigen::AngleAxisd(angle_rad, axis).toRotationMatrix();
}

Eigen::Vector3d rayOf(const VirtualPinhole& pinhole, const Eigen::Vector2d& view_px) {
  const Eigen::Vector2d m = (view_px - pinhole.centre_px).cwiseQuotient(pinhole.focal_px);
  return pinhole.R_cam_view * m.homogeneous();
}

/// Camera pixel of every view pixel, CV_32FC2.
cv::Mat lookUpTable(const camera::Camera& camera, const VirtualPinhole& pinhole) {
  const float max_x = static_cast<float>(camera.width) - kNowhere_px;
  const float max_y = static_cast<float>(camera.height) - kNowhere_px;
  cv::Mat table(pinhole.height, pinhole.width, CV_32FC2);
  for (int row = 0; row < pinhole.height; ++row) {
    auto* pixels = table.ptr<cv::Vec2f>(row);
    for (int col = 0; col < pinhole.width; ++col) {
      const auto px = project(camera.model, rayOf(pinhole, {col, row}));
      const Eigen::Vector2f at = px ? Eigen::Vector2f(px->cast<float>()) : Eigen::Vector2f::Constant(kNowhere_px);
      pixels[col] = {std::clamp(at.x(), kNowhere_px, max_x), std::clamp(at.y(), kNowhere_px, max_y)};
    }
  }
  return table;
}

}  // namespace

VirtualPinhole pinholeView(const ViewSize& size, double about_x_rad, double about_z_rad) {
  VirtualPinhole pinhole;
  pinhole.R_cam_view = rotation(about_z_rad, Eigen::Vector3d::UnitZ()) * rotation(about_x_rad, Eigen::Vector3d::UnitX());
  pinhole.width = size.width;
  pinhole.height = size.height;
  pinhole.centre_px = 0.5 * Eigen::Vector2d(size.width - 1, size.height - 1);
  pinhole.focal_px =
      pinhole.centre_px.cwiseQuotient(Eigen::Vector2d(std::tan(0.5 * size.fov_x_rad), std::tan(0.5 * size.fov_y_rad)));
  return pinhole;
}

std::array<VirtualPinhole, 5> cubeViews(const ViewSize& size) {
  const auto side = [&size](int quarter_turns) { return pinholeView(size, 0.5 * kPi, 0.5 * kPi * quarter_turns); };
  return {side(0), side(1), side(2), side(3), pinholeView(size, 0.0, 0.0)};
}

std::optional<VirtualPinhole> rectifiedView(const geometry::Rigid3& T_cam_target,
                                            const std::vector<Eigen::Vector3d>& target_points, int width, int height) {
  const Eigen::Matrix3d R_target_view = Eigen::Vector3d(1.0, -1.0, -1.0).asDiagonal();
  VirtualPinhole pinhole;
  pinhole.R_cam_view = T_cam_target.rotation.toRotationMatrix() * R_target_view;
  pinhole.width = width;
  pinhole.height = height;
  const Eigen::Vector3d t_view = pinhole.R_cam_view.transpose() * T_cam_target.translation;
  if (!(t_view.z() > 0.0)) {
    return std::nullopt;
  }
  Eigen::Vector3d low = target_points.front();
  Eigen::Vector3d high = target_points.front();
  for (const Eigen::Vector3d& point : target_points) {
    low = low.cwiseMin(point);
    high = high.cwiseMax(point);
  }
  const Eigen::Vector2d extent_m = (high - low).head<2>();
  const double px_per_m = kRectifiedShare * std::min(width / extent_m.x(), height / extent_m.y());
  const Eigen::Vector2d middle_m = (R_target_view * (0.5 * (low + high)) + t_view).head<2>();
  pinhole.focal_px.setConstant(px_per_m * t_view.z());
  pinhole.centre_px = 0.5 * Eigen::Vector2d(width - 1, height - 1) - px_per_m * middle_m;
  return pinhole;
}

VirtualView::VirtualView(const camera::Camera& camera, const VirtualPinhole& pinhole) : camera_(camera), pinhole_(pinhole) {
  cv::convertMaps(lookUpTable(camera, pinhole), cv::Mat(), position_, fraction_, CV_16SC2);
}

cv::Mat VirtualView::remap(const cv::Mat& gray) const {
  cv::Mat view;
  cv::remap(gray, view, position_, fraction_, cv::INTER_LINEAR, cv::BORDER_CONSTANT, cv::Scalar(0));
  return view;
}

std::optional<Eigen::Vector2d> VirtualView::toImage(const Eigen::Vector2d& view_px) const {
  return camera::project(camera_.model, rayOf(pinhole_, view_px));
}

std::optional<Eigen::Vector2d> VirtualView::toView(const Eigen::Vector2d& image_px) const {
  const auto ray_cam = camera::unproject(camera_.model, image_px);
  if (!ray_cam) {
    return std::nullopt;
  }
  const Eigen::Vector3d ray_view = pinhole_.R_cam_view.transpose() * *ray_cam;
  if (!(ray_view.z() > 0.0)) {
    return std::nullopt;
  }
  return Eigen::Vector2d(ray_view.hnormalized().cwiseProduct(pinhole_.focal_px) + pinhole_.centre_px);
}

}  // namespace tartan_calib::pipeline
