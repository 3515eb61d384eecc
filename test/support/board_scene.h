#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <map>
#include <opencv2/core.hpp>
#include <vector>

#include "tartan_calib/camera/camera.h"
#include "tartan_calib/geometry/rigid3.h"
#include "tartan_calib/simulation/board_layer.h"
#include "tartan_calib/simulation/board_pattern.h"
#include "tartan_calib/simulation/sensor.h"
#include "tartan_calib/simulation/true_corner.h"
#include "tartan_calib/target/target.h"

namespace tartan_calib::test_support {

constexpr double kDegree = 3.14159265358979323846 / 180.0;

/// Pose of a board whose centre is at `distance_m` from the camera in a direction `polar` from the axis at `azimuth`; facing
/// the camera there, then tilted about its own x and y and rolled about its normal.
struct BoardPose {
  double distance_m = 1.0;
  double polar_rad = 0.0;
  double azimuth_rad = 0.0;
  double tilt_x_rad = 0.0;
  double tilt_y_rad = 0.0;
  double roll_rad = 0.0;
};

inline geometry::Rigid3 poseOf(const target::Target& target, const BoardPose& pose) {
  const Eigen::Vector3d centre_target = 0.5 * (target::cornerPoints(target).front() + target::cornerPoints(target).back());
  const Eigen::Vector3d aim_axis(-std::sin(pose.azimuth_rad), std::cos(pose.azimuth_rad), 0.0);
  const Eigen::Quaterniond aim(Eigen::AngleAxisd(pose.polar_rad, aim_axis));
  const Eigen::Quaterniond facing(Eigen::AngleAxisd(180.0 * kDegree, Eigen::Vector3d::UnitX()));
  const Eigen::Quaterniond R_cam_target = aim * Eigen::AngleAxisd(pose.roll_rad, Eigen::Vector3d::UnitZ()) *
                                          Eigen::AngleAxisd(pose.tilt_y_rad, Eigen::Vector3d::UnitY()) *
                                          Eigen::AngleAxisd(pose.tilt_x_rad, Eigen::Vector3d::UnitX()) * facing;
  return {R_cam_target, aim * Eigen::Vector3d(0.0, 0.0, pose.distance_m) - R_cam_target * centre_target};
}

/// A picture in the making: light on the sensor before blur and noise.
class BoardScene {
 public:
  explicit BoardScene(camera::Camera camera, double background_grey = 110.0)
      : camera_(std::move(camera)), grey_(camera_.height, camera_.width, static_cast<float>(background_grey)) {}

  /// Draws a board over what is there and returns its corners.
  std::vector<simulation::TrueCorner> add(const target::Target& target, const BoardPose& pose) {
    return add(simulation::boardPattern(target, kMargin_m), target, pose);
  }

  std::vector<simulation::TrueCorner> add(const simulation::BoardPattern& pattern, const target::Target& target,
                                          const BoardPose& pose) {
    return add(pattern, target, poseOf(target, pose));
  }

  std::vector<simulation::TrueCorner> add(const simulation::BoardPattern& pattern, const target::Target& target,
                                          const geometry::Rigid3& T_cam_target) {
    const simulation::BoardLayer board = simulation::drawBoard(pattern, camera_, T_cam_target);
    if (!board.window.empty()) {
      cv::Mat behind = grey_(board.window);
      const cv::Mat seen =
          behind.mul(1.0F - board.sheet) + board.sheet * kBlackGrey + board.white * (kWhiteGrey - kBlackGrey);
      seen.copyTo(behind);
    }
    return simulation::projectCorners(target, camera_, T_cam_target);
  }

  cv::Mat1f& grey() { return grey_; }
  const camera::Camera& camera() const { return camera_; }

  cv::Mat expose(double psf_sigma_px, double noise_grey, std::uint64_t seed = 1) const {
    cv::Mat1f blurred = grey_.clone();
    simulation::applyPsf(blurred, psf_sigma_px);
    simulation::SensorOptions sensor;
    sensor.read_noise_grey = noise_grey;
    return simulation::expose(blurred, sensor, seed);
  }

  static constexpr double kMargin_m = 0.04;
  static constexpr double kWhiteGrey = 200.0;
  static constexpr double kBlackGrey = 25.0;

 private:
  camera::Camera camera_;
  cv::Mat1f grey_;
};

inline camera::Camera pinholeCamera(int width, int height, double focal_px) {
  return {camera::startModel(camera::modelByName("pinhole-none"), focal_px, {0.5 * (width - 1), 0.5 * (height - 1)}), width,
          height};
}

/// Equidistant fisheye.
inline camera::Camera fisheyeCamera(int width, int height, double focal_px) {
  return {camera::startModel(camera::modelByName("pinhole-equi"), focal_px, {0.5 * (width - 1), 0.5 * (height - 1)}), width,
          height};
}

}  // namespace tartan_calib::test_support
