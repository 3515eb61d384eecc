#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <vector>

#include "tartan_calib/camera/camera.h"

namespace tartan_calib::calibration {

/// Where two calibrations of the same camera send a ray, in pixels of both.
struct PixelDifference {
  Eigen::Vector2d px = Eigen::Vector2d::Zero();             ///< in calibration a
  Eigen::Vector2d difference_px = Eigen::Vector2d::Zero();  ///< pixel in b minus pixel in a, for the same ray
};

/// Difference of two projections with the rotation between their camera frames removed: a free rotation of the camera frame
/// is taken up by the board poses, so calibrations of one lens that differ by it are the same calibration (mrcal's
/// projection difference at infinity).
struct ProjectionDifference {
  Eigen::Quaterniond R_b_a = Eigen::Quaterniond::Identity();
  std::vector<PixelDifference> pixels;  ///< samples that both models can use
  double rms_px = 0.0;                  ///< sqrt(mean |difference|^2)
  double max_px = 0.0;
};

/// Compares at the given pixels of a; R_b_a minimises the sum of squared differences over them. Throws CalibrationError
/// where fewer than three samples can be used.
ProjectionDifference compareProjections(const camera::CameraModel& a, const camera::CameraModel& b,
                                        const std::vector<Eigen::Vector2d>& samples_px);

/// A regular grid over the image, `spacing_px` apart, centred.
std::vector<Eigen::Vector2d> imageGrid(int width, int height, double spacing_px);

}  // namespace tartan_calib::calibration
