#pragma once

#include <optional>
#include <ostream>
#include <string>
#include <vector>

#include "support/simulated_scene.h"
#include "tartan_calib/calibration/initialize_camera.h"

/// Calibrations of random lenses from nothing but corners, and whether they succeed.
namespace tartan_calib::test_support {

/// What makes a recording hard.
struct Condition {
  std::string name;
  int num_views = 40;
  Facing facing = Facing::kCamera;
  double max_tilt_rad = 0.8;
  double wrong_ratio = 0.03;
  double wrong_sigma_px = 30.0;
  double noise_px = 0.3;
  double centre_offset_ratio = 0.02;  ///< of the principal point from the image centre, in image widths, in any direction
  double aspect_ratio = 1.0;          ///< fv / fu
  int min_corners = 16;
  int max_corners = 1 << 20;
};

/// What a failing test shows of its parameter.
inline std::ostream& operator<<(std::ostream& stream, const Condition& condition) { return stream << condition.name; }

/// A model that is fitted, and a lens that it can represent: to 0.5 px in the worst case, where the two differ.
struct LensPair {
  const char* fitted;
  const char* truth;
  double max_fov_deg;
};

/// Every model with its own lenses and with others'.
std::vector<LensPair> lensPairs();

struct Trial {
  LensPair lens;
  double fov_rad = 0.0;
  Scene scene;
  std::vector<observation::CameraView> views;  ///< with noise and wrong corners
};

constexpr int kTrialWidth = 1280;
constexpr int kTrialHeight = 960;

/// The lens of that number under a condition; fields of view are spread over 60 degrees to what the pair allows.
Trial makeTrial(const Condition& condition, int number);

/// A camera with a pose for each view that it explains.
struct PosedCamera {
  camera::Camera camera;
  std::vector<std::optional<geometry::Rigid3>> T_cam_target;
};

PosedCamera withPoses(const camera::Camera& camera, const Scene& scene, const std::vector<observation::CameraView>& views);

/// Share of all corners, wrong ones at their right place, that the camera puts within `limit_px` of the truth.
double shareWithin(double limit_px, const PosedCamera& posed, const Scene& scene);

/// The start followed by the solve of all views; views without a pose keep none. Throws CalibrationError where calibrate
/// would refuse the result.
PosedCamera startAndSolve(const std::string& model_name, const Scene& scene,
                          const std::vector<observation::CameraView>& views);

/// Empty where 97 % of the corners of all views are within 1.5 px of the truth after the solve, else what went wrong.
std::optional<std::string> failure(const Trial& trial);

}  // namespace tartan_calib::test_support
