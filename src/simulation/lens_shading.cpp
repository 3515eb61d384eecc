#include "lens_shading.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace tartan_calib::simulation {
namespace {

constexpr int kLightStepPx = 8;

}  // namespace

Eigen::Vector2d principalPoint(const camera::Camera& camera) {
  return camera::parameters(camera.model).segment<2>(camera::focalIndex(camera.model) + 2);
}

double distanceInsideCircle(const SceneCamera& camera, const Eigen::Vector2d& px) {
  return camera.image_circle_px - (px - principalPoint(camera.camera)).norm();
}

cv::Mat1f lensShading(const SceneCamera& camera) {
  // A slow loss over the field, then the barrel cuts the pencils of light in the last tenth.
  constexpr double kFieldPart = 0.4;
  constexpr int kBarrelPower = 16;
  const Eigen::Vector2d centre = principalPoint(camera.camera);
  const double corner_px = 0.5 * std::hypot(camera.camera.width, camera.camera.height);
  const double rim_px = std::min(camera.image_circle_px, corner_px);
  cv::Mat1f shading(camera.camera.height, camera.camera.width);
  for (int row = 0; row < shading.rows; ++row) {
    for (int col = 0; col < shading.cols; ++col) {
      const double r = (Eigen::Vector2d(col, row) - centre).norm();
      const double ratio = std::min(1.0, r / rim_px);
      const double loss =
          camera.vignetting * (kFieldPart * ratio * ratio + (1.0 - kFieldPart) * std::pow(ratio, kBarrelPower));
      const double inside = std::clamp(camera.image_circle_px - r + 0.5, 0.0, 1.0);
      shading(row, col) = static_cast<float>((1.0 - loss) * inside);
    }
  }
  return shading;
}

BoardLight::BoardLight(const SceneCamera& camera, const Lighting& lighting)
    : size_(camera.camera.width, camera.camera.height),
      lighting_(lighting),
      lamp_cam_(camera.T_cam_rig.rotation * lighting.lamp_rig.normalized()),
      rays_cam_((size_.height + kLightStepPx - 1) / kLightStepPx, (size_.width + kLightStepPx - 1) / kLightStepPx,
                cv::Vec3f(0.0F, 0.0F, 0.0F)) {
  const double first_px = 0.5 * (kLightStepPx - 1);
  for (int row = 0; row < rays_cam_.rows; ++row) {
    for (int col = 0; col < rays_cam_.cols; ++col) {
      const Eigen::Vector2d px(first_px + col * kLightStepPx, first_px + row * kLightStepPx);
      if (const auto ray = camera::unproject(camera.camera.model, px)) {
        const Eigen::Vector3f ray_cam = ray->cast<float>();
        rays_cam_(row, col) = cv::Vec3f(ray_cam.x(), ray_cam.y(), ray_cam.z());
      }
    }
  }
}

cv::Mat1f BoardLight::onBoard(const Eigen::Vector3d& normal_cam) const {
  const double lamp = std::max(0.0, normal_cam.dot(lamp_cam_));
  const double matt = lighting_.ambient_ratio + (1.0 - lighting_.ambient_ratio) * lamp;
  const double sharpness = 1.0 / (lighting_.sheen_width_rad * lighting_.sheen_width_rad);
  cv::Mat1f coarse(rays_cam_.size());
  for (int row = 0; row < coarse.rows; ++row) {
    for (int col = 0; col < coarse.cols; ++col) {
      const cv::Vec3f& r = rays_cam_(row, col);
      const Eigen::Vector3d ray(static_cast<double>(r[0]), static_cast<double>(r[1]), static_cast<double>(r[2]));
      const Eigen::Vector3d mirrored = ray - 2.0 * ray.dot(normal_cam) * normal_cam;
      const double sheen = lighting_.sheen_ratio * std::exp(sharpness * (mirrored.dot(lamp_cam_) - 1.0));
      coarse(row, col) = static_cast<float>(matt + sheen);
    }
  }
  cv::Mat1f whole;
  cv::resize(coarse, whole, coarse.size() * kLightStepPx, 0.0, 0.0, cv::INTER_LINEAR);
  return whole(cv::Rect(cv::Point(), size_));
}

}  // namespace tartan_calib::simulation
