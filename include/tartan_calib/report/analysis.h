#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tartan_calib/pipeline/calibrate.h"
#include "tartan_calib/report/camera_timing.h"
#include "tartan_calib/report/listener.h"
#include "tartan_calib/report/pictures.h"
#include "tartan_calib/report/seen_corners.h"

namespace tartan_calib::report {

/// One pixel of the maps over the image.
struct MapSample {
  Eigen::Vector2d px = Eigen::Vector2d::Zero();
  std::optional<double> polar_rad;  ///< empty where the model has no ray
  bool is_seen = true;              ///< false where the lens throws no light, by the pictures
  std::optional<double> stdev_px;
  std::optional<double> difference_px;           ///< between the calibrations of the even and the odd views
  std::optional<double> expected_difference_px;  ///< what the uncertainties of the two leave to expect: a stdev
};

/// A regular grid over the image, row by row.
struct ProjectionMap {
  int rows = 0;
  int cols = 0;
  std::vector<MapSample> samples;
};

/// Mean residual away from the principal point in a band of polar angles, over the means of its images: corners of one image
/// share errors, so the images are what counts for its stdev.
struct RadialBias {
  double from_rad = 0.0;
  double to_rad = 0.0;
  int num_images = 0;
  double mean_px = 0.0;
  double stdev_px = 0.0;
};

struct CameraAnalysis {
  SeenCorners corners;
  ProjectionMap map;
  double reach_rad = 0.0;                  ///< polar angle up to which the image shows something
  double extrapolated_ratio = 0.0;         ///< share of the seen map beyond the farthest used corner
  std::vector<std::string> empty_regions;  ///< ninths of the image without a corner, such as "lower left"
  double focal_stdev_ratio = 0.0;
  double median_stdev_px = 0.0;                ///< of the map within reach of the corners
  std::optional<double> median_difference_px;  ///< likewise; empty where the halves were not solved
  double median_expected_difference_px = 0.0;
  std::vector<RadialBias> radial_biases;
};

struct Analysis {
  std::vector<CameraAnalysis> cameras;
  std::vector<CameraTiming> timings;
};

/// Everything about a result that needs its camera models. `pictures` may be empty. `corners`: seenCorners(result). Throws
/// pipeline::Cancelled where the listener cancels.
Analysis analyse(const pipeline::CalibrationResult& result, const pipeline::CalibrateOptions& options,
                 std::vector<SeenCorners> corners, const std::vector<CameraPictures>& pictures,
                 const Listener& listener = {});

}  // namespace tartan_calib::report
