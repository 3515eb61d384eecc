#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "tartan_calib/camera/camera.h"
#include "tartan_calib/geometry/rigid3.h"

namespace tartan_calib::calibration {

/// Where two calibrations of the same camera send a ray, in pixels of both.
struct PixelDifference {
  Eigen::Vector2d px = Eigen::Vector2d::Zero();             ///< in calibration a
  Eigen::Vector2d difference_px = Eigen::Vector2d::Zero();  ///< pixel in b minus pixel in a, for the same ray
};

/// Difference of two projections with the motion between their camera frames removed: where the camera frame sits behind the
/// lens is taken up by the board poses, so calibrations of one lens that differ by it are the same calibration (mrcal's
/// projection difference). At infinity that motion is a rotation; at a finite distance a translation shows too.
struct ProjectionDifference {
  geometry::Rigid3 T_b_a;
  std::vector<PixelDifference> pixels;  ///< samples that both models can use
  double rms_px = 0.0;                  ///< sqrt(mean |difference|^2)
  double max_px = 0.0;
};

/// Compares at the given pixels of a, for points at `distance_m` from the camera (at infinity where empty); T_b_a minimises
/// the sum of squared differences over them. Throws CalibrationError where fewer than three samples can be used.
ProjectionDifference compareProjections(const camera::CameraModel& a, const camera::CameraModel& b,
                                        const std::vector<Eigen::Vector2d>& samples_px,
                                        std::optional<double> distance_m = std::nullopt);

/// A regular grid over the image, `spacing_px` apart, centred.
std::vector<Eigen::Vector2d> imageGrid(int width, int height, double spacing_px);

}  // namespace tartan_calib::calibration
