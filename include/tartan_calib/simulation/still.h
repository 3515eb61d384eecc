#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <vector>

#include "tartan_calib/camera/camera.h"
#include "tartan_calib/geometry/rigid3.h"
#include "tartan_calib/simulation/true_corner.h"
#include "tartan_calib/target/target.h"

namespace tartan_calib::simulation {

/// Looks of a single picture of a board before a plain background; grey levels of 8 bits.
struct StillOptions {
  double white_grey = 210.0;
  double black_grey = 25.0;
  double background_grey = 110.0;
  double margin_m = 0.05;     ///< white paper around the pattern
  double psf_sigma_px = 0.6;  ///< Gaussian, beside the pixel's own square
  double noise_sigma = 0.0;   ///< grey levels
  std::uint64_t seed = 1;
};

struct Still {
  cv::Mat image;  ///< CV_8UC1
  std::vector<TrueCorner> corners;
};

/// The smallest useful simulation: one board, one camera, one pose. Recordings with everything else come from Renderer.
Still renderStill(const target::Target& target, const camera::Camera& camera, const geometry::Rigid3& T_cam_target,
                  const StillOptions& options = {});

}  // namespace tartan_calib::simulation
