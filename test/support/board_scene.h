#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <vector>

#include "tartan_calib/camera/camera.h"
#include "tartan_calib/geometry/rigid3.h"
#include "tartan_calib/simulation/board_pattern.h"
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

geometry::Rigid3 poseOf(const target::Target& target, const BoardPose& pose);

/// A picture in the making: light on the sensor before blur and noise.
class BoardScene {
 public:
  explicit BoardScene(camera::Camera camera, double background_grey = 110.0);

  /// Draws a board over what is there and returns its corners.
  std::vector<simulation::TrueCorner> add(const target::Target& target, const BoardPose& pose);
  std::vector<simulation::TrueCorner> add(const simulation::BoardPattern& pattern, const target::Target& target,
                                          const BoardPose& pose);
  std::vector<simulation::TrueCorner> add(const simulation::BoardPattern& pattern, const target::Target& target,
                                          const geometry::Rigid3& T_cam_target);

  cv::Mat1f& grey() { return grey_; }
  const camera::Camera& camera() const { return camera_; }

  cv::Mat expose(double psf_sigma_px, double noise_grey, std::uint64_t seed = 1) const;

  static constexpr double kMargin_m = 0.04;
  static constexpr double kWhiteGrey = 200.0;
  static constexpr double kBlackGrey = 25.0;

 private:
  camera::Camera camera_;
  cv::Mat1f grey_;
};

camera::Camera pinholeCamera(int width, int height, double focal_px);

/// Equidistant fisheye.
camera::Camera fisheyeCamera(int width, int height, double focal_px);

}  // namespace tartan_calib::test_support
