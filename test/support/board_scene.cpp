#include "support/board_scene.h"

#include <Eigen/Geometry>
#include <utility>

#include "tartan_calib/simulation/board_layer.h"
#include "tartan_calib/simulation/sensor.h"

namespace tartan_calib::test_support {

geometry::Rigid3 poseOf(const target::Target& target, const BoardPose& pose) {
  const Eigen::Vector3d centre_target = 0.5 * (target::cornerPoints(target).front() + target::cornerPoints(target).back());
  const Eigen::Vector3d aim_axis(-std::sin(pose.azimuth_rad), std::cos(pose.azimuth_rad), 0.0);
  const Eigen::Quaterniond aim(Eigen::AngleAxisd(pose.polar_rad, aim_axis));
  const Eigen::Quaterniond facing(Eigen::AngleAxisd(180.0 * kDegree, Eigen::Vector3d::UnitX()));
  const Eigen::Quaterniond R_cam_target = aim * Eigen::AngleAxisd(pose.roll_rad, Eigen::Vector3d::UnitZ()) *
                                          Eigen::AngleAxisd(pose.tilt_y_rad, Eigen::Vector3d::UnitY()) *
                                          Eigen::AngleAxisd(pose.tilt_x_rad, Eigen::Vector3d::UnitX()) * facing;
  return {R_cam_target, aim * Eigen::Vector3d(0.0, 0.0, pose.distance_m) - R_cam_target * centre_target};
}

BoardScene::BoardScene(camera::Camera camera, double background_grey)
    : camera_(std::move(camera)), grey_(camera_.height, camera_.width, static_cast<float>(background_grey)) {}

std::vector<simulation::TrueCorner> BoardScene::add(const target::Target& target, const BoardPose& pose) {
  return add(simulation::boardPattern(target, kMargin_m), target, pose);
}

std::vector<simulation::TrueCorner> BoardScene::add(const simulation::BoardPattern& pattern, const target::Target& target,
                                                    const BoardPose& pose) {
  return add(pattern, target, poseOf(target, pose));
}

std::vector<simulation::TrueCorner> BoardScene::add(const simulation::BoardPattern& pattern, const target::Target& target,
                                                    const geometry::Rigid3& T_cam_target) {
  const simulation::BoardLayer board = simulation::drawBoard(pattern, camera_, T_cam_target);
  if (!board.window.empty()) {
    cv::Mat behind = grey_(board.window);
    const cv::Mat seen = behind.mul(1.0F - board.sheet) + board.sheet * kBlackGrey + board.white * (kWhiteGrey - kBlackGrey);
    seen.copyTo(behind);
  }
  return simulation::projectCorners(target, camera_, T_cam_target);
}

cv::Mat BoardScene::expose(double psf_sigma_px, double noise_grey, std::uint64_t seed) const {
  cv::Mat1f blurred = grey_.clone();
  simulation::applyPsf(blurred, psf_sigma_px);
  simulation::SensorOptions sensor;
  sensor.read_noise_grey = noise_grey;
  return simulation::expose(blurred, sensor, seed);
}

camera::Camera pinholeCamera(int width, int height, double focal_px) {
  return {camera::startModel(camera::modelByName("pinhole-none"), focal_px, {0.5 * (width - 1), 0.5 * (height - 1)}), width,
          height};
}

camera::Camera fisheyeCamera(int width, int height, double focal_px) {
  return {camera::startModel(camera::modelByName("pinhole-equi"), focal_px, {0.5 * (width - 1), 0.5 * (height - 1)}), width,
          height};
}

}  // namespace tartan_calib::test_support
