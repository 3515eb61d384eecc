#pragma once

#include <Eigen/Core>
#include <array>
#include <opencv2/core.hpp>
#include <vector>

namespace tartan_calib::detection {

/// An X-junction: two edges cross, opposite wedges are dark and light. Angles are in image axes (x right, y down, so they
/// increase clockwise on the screen).
struct Saddle {
  Eigen::Vector2d px = Eigen::Vector2d::Zero();  ///< full-resolution pixels
  /// Directions of the four edge arms, increasing, the first in [0, 2 pi). The wedges [0, 1] and [2, 3] are dark, [1, 2]
  /// and [3, 0] are light; arms 0, 2 and 1, 3 are each one edge, bent a little where the lens bends it.
  std::array<double, 4> arm_rad = {};
  double contrast = 0.0;  ///< light minus dark wedges, as far as blur leaves it [grey levels]
  double scale_px = 1.0;  ///< full-resolution pixels per pixel of the pyramid level where it was seen best
};

struct SaddleOptions {
  double min_contrast = 8.0;  ///< [grey levels]
  int num_levels = 4;         ///< pyramid levels, each half the size; as many as fit into the image
  /// Bounds time on texture: at most one saddle per so many pixels is examined at a level, the strongest first.
  int min_px2_per_saddle = 150;
};

/// All X-junctions of `gray` (CV_8UC1), good to about 0.15 px, strongest first. Blurred ones come from coarser levels.
std::vector<Saddle> findSaddles(const cv::Mat& gray, const SaddleOptions& options = {});

}  // namespace tartan_calib::detection
