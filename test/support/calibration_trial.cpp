#include "support/calibration_trial.h"

#include <cmath>

#include "tartan_calib/calibration/intrinsics_uncertainty.h"
#include "tartan_calib/calibration/pose.h"
#include "tartan_calib/calibration/solve.h"
#include "tartan_calib/error.h"

namespace tartan_calib::test_support {

std::vector<LensPair> lensPairs() {
  return {{"pinhole-none", "pinhole-none", 150},   {"pinhole-radtan", "pinhole-radtan", 120},
          {"pinhole-equi", "pinhole-equi", 260},   {"pinhole-fov", "pinhole-fov", 260},
          {"omni-none", "omni-none", 260},         {"omni-radtan", "omni-radtan", 200},
          {"eucm-none", "eucm-none", 260},         {"ds-none", "ds-none", 260},
          {"pinhole-radtan", "pinhole-none", 150}, {"pinhole-equi", "ds-none", 240},
          {"pinhole-equi", "eucm-none", 240},      {"pinhole-equi", "omni-none", 240},
          {"pinhole-equi", "pinhole-fov", 240},    {"omni-radtan", "omni-none", 260},
          {"eucm-none", "omni-none", 260},         {"ds-none", "omni-none", 260},
          {"eucm-none", "pinhole-none", 150},      {"ds-none", "pinhole-none", 150},
          {"pinhole-equi", "pinhole-none", 130},   {"omni-radtan", "pinhole-none", 110}};
}

Trial makeTrial(const Condition& condition, int number) {
  const auto seed = static_cast<unsigned>(number);
  Random random(1000 + seed);
  const std::vector<LensPair> pairs = lensPairs();
  Trial trial;
  trial.lens = pairs[static_cast<std::size_t>(number) % pairs.size()];
  trial.fov_rad = uniform(random, 60.0, trial.lens.max_fov_deg) * M_PI / 180.0;
  camera::Camera camera = randomCamera(trial.lens.truth, trial.fov_rad, kTrialWidth, kTrialHeight, random);
  Eigen::VectorXd parameters = camera::parameters(camera.model);
  const int focal = camera::focalIndex(camera.model);
  const double azimuth_rad = uniform(random, -M_PI, M_PI);
  const double offset_px = condition.centre_offset_ratio * kTrialWidth;
  parameters(focal + 1) *= condition.aspect_ratio;
  parameters(focal + 2) += offset_px * std::cos(azimuth_rad);
  parameters(focal + 3) += offset_px * std::sin(azimuth_rad);
  camera.model = camera::withParameters(camera.model, parameters);
  SceneOptions options;
  options.num_views = condition.num_views;
  options.max_polar_angle_rad = 0.5 * trial.fov_rad;
  options.max_tilt_rad = condition.max_tilt_rad;
  options.facing = condition.facing;
  options.min_corners = condition.min_corners;
  options.max_corners = condition.max_corners;
  options.seed = 1 + seed;
  trial.scene = simulateScene(camera, options);
  std::vector<observation::View> views = trial.scene.views;
  addNoise(views, condition.noise_px, 2000 + seed);
  addWrongCorners(views, condition.wrong_ratio, condition.wrong_sigma_px, 3000 + seed);
  trial.views = viewsOf(views, 0);
  return trial;
}

PosedCamera withPoses(const camera::Camera& camera, const Scene& scene, const std::vector<observation::CameraView>& views) {
  constexpr int kAllCores = 0;
  return {camera, calibration::estimatePoses(camera, scene.target_points, views, kAllCores)};
}

double shareWithin(double limit_px, const PosedCamera& posed, const Scene& scene) {
  const std::vector<observation::CameraView> views = viewsOf(scene.views, 0);
  double num_good = 0.0;
  double num_all = 0.0;
  for (std::size_t v = 0; v < views.size(); ++v) {
    for (const observation::Corner& corner : views[v].corners) {
      num_all += 1.0;
      const Eigen::Vector3d& p_target = scene.target_points[static_cast<std::size_t>(corner.corner_id)];
      const auto& T_cam_target = posed.T_cam_target[v];
      const auto px = T_cam_target ? camera::project(posed.camera.model, *T_cam_target * p_target) : std::nullopt;
      num_good += px && (*px - corner.px).norm() <= limit_px ? 1.0 : 0.0;
    }
  }
  return num_good / num_all;
}

PosedCamera startAndSolve(const std::string& model_name, const Scene& scene,
                          const std::vector<observation::CameraView>& views) {
  calibration::CameraSpec spec;
  spec.model_name = model_name;
  spec.width = kTrialWidth;
  spec.height = kTrialHeight;
  PosedCamera posed = withPoses(calibration::initializeCamera(spec, scene.target_points, views).camera, scene, views);
  calibration::Problem problem;
  problem.target_points = scene.target_points;
  problem.rig.cameras = {{posed.camera, geometry::Rigid3()}};
  for (std::size_t v = 0; v < views.size(); ++v) {
    if (posed.T_cam_target[v]) {
      problem.views.push_back({views[v].stamp_ns, {views[v]}});
      problem.T_rig_target.push_back(*posed.T_cam_target[v]);
    }
  }
  const calibration::Solution solution = calibration::solve(problem, calibration::SolveOptions());
  const bool is_converged = solution.status == calibration::SolveStatus::kConverged;
  if (!is_converged && calibration::focalStdevRatio(solution, 0) > calibration::kMeaninglessFocal_ratio) {
    throw CalibrationError("the solver did not converge, and the focal length is open");
  }
  posed.camera = solution.rig.cameras[0].camera;
  std::size_t solved = 0;
  for (std::optional<geometry::Rigid3>& T_cam_target : posed.T_cam_target) {
    if (T_cam_target) {
      T_cam_target = solution.T_rig_target[solved++];
    }
  }
  return posed;
}

std::optional<std::string> failure(const Trial& trial) {
  constexpr double kLimit_px = 1.5;
  constexpr double kShare = 0.97;
  const std::string name = std::string(trial.lens.fitted) + " on " + trial.lens.truth + " of " +
                           std::to_string(std::lround(trial.fov_rad * 180.0 / M_PI)) + " degrees: ";
  try {
    const double share = shareWithin(kLimit_px, startAndSolve(trial.lens.fitted, trial.scene, trial.views), trial.scene);
    if (share >= kShare) {
      return std::nullopt;
    }
    return name + std::to_string(share) + " of the corners within 1.5 px";
  } catch (const CalibrationError& error) {
    return name + error.what();
  }
}

}  // namespace tartan_calib::test_support
