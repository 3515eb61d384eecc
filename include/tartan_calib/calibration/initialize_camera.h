#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "tartan_calib/camera/camera.h"
#include "tartan_calib/observation/observation.h"

namespace tartan_calib::calibration {

/// A camera to be started: the model that the user asked for and the images it took.
struct CameraSpec {
  std::string model_name;  ///< ds-none
  int width = 0;
  int height = 0;
  std::optional<double> focal_hint_px;             ///< of the image centre, from KALIBR_MANUAL_FOCAL_LENGTH_INIT
  std::optional<camera::CameraModel> known_model;  ///< from --init: nothing is searched
  int num_threads = 0;  ///< of the search; 0: all cores. The result has the same bits for every value
};

struct CameraStart {
  camera::Camera camera;
  std::vector<std::string> warnings;  ///< why the start may be weak; one line each
};

/// Intrinsics of one camera from nothing but corners (any central lens of 60-260 degrees): radial 1D constraint,
/// division model, target model by regression, robust bundle adjustment. Deterministic. Throws CalibrationError that says
/// how many corners and views there were and how many are needed.
CameraStart initializeCamera(const CameraSpec& spec, const std::vector<Eigen::Vector3d>& target_points,
                             const std::vector<observation::CameraView>& views);

}  // namespace tartan_calib::calibration
