#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "model_fit.h"
#include "tartan_calib/observation/observation.h"

namespace tartan_calib::calibration {

/// What a search needs to know about the image.
struct ImageInfo {
  int width = 0;
  int height = 0;
  std::optional<double> focal_hint_px;
  int num_threads = 0;  ///< of the search; 0: all cores. The result has the same bits for every value
};

/// A radially symmetric lens, as samples that any model can be fitted to.
struct LensGuess {
  Eigen::Vector2d centre_px = Eigen::Vector2d::Zero();
  double focal_px = 0.0;  ///< image scale in the centre, pixels per radian
  double max_angle_rad = 0.0;
  std::vector<RayPixel> samples;  ///< out to the last radius that was seen
};

/// Lenses that may have taken the views, most likely first, from the radial 1D constraint and the division model. Empty
/// where no view obeys the constraint.
std::vector<LensGuess> searchLens(const ImageInfo& image, const std::vector<Eigen::Vector3d>& target_points,
                                  const std::vector<observation::CameraView>& views);

}  // namespace tartan_calib::calibration
