#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "tartan_calib/pipeline/calibrate.h"

namespace tartan_calib::report {

/// A corner found in an image whose board pose is known.
struct FoundCorner {
  int view = 0;  ///< index in Solution::views
  int corner_id = -1;
  Eigen::Vector2d px = Eigen::Vector2d::Zero();
  std::optional<Eigen::Vector2d> residual_px;  ///< measured minus predicted; empty where the model gives it no image
  std::optional<double> polar_rad;             ///< of the measured ray, from the optical axis; empty where it has none
  double azimuth_rad = 0.0;                    ///< of the measured ray, from the image's x axis towards y
  bool used = true;
  int round = 0;
};

/// A corner that the solution expects in the image, on a board seen from its front, but that was not found: hidden, blurred,
/// too small, or outside of the lens's image circle.
struct MissedCorner {
  int view = 0;
  int corner_id = -1;
  Eigen::Vector2d px = Eigen::Vector2d::Zero();
  double polar_rad = 0.0;
};

struct SeenCorners {
  std::vector<FoundCorner> found;  ///< by view, then corner id
  std::vector<MissedCorner> missed;
};

/// By camera.
std::vector<SeenCorners> seenCorners(const pipeline::CalibrationResult& result);

/// Angle of the ray of a pixel from the optical axis; empty where it has none.
std::optional<double> polarAngle(const camera::CameraModel& model, const Eigen::Vector2d& px);

}  // namespace tartan_calib::report
