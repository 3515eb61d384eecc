#include "pupil_hint.h"

#include "tartan_calib/calibration/statistics.h"
#include "tartan_calib/pipeline/richer_models.h"
#include "tartan_calib/text.h"

namespace tartan_calib::pipeline {
namespace {

/// Stdev of a residual's component above which a lens model is worth a second look.
constexpr double kLargeSigma_px = 0.2;
/// A moving pupil that leaves more than this share of the residuals is not what is wrong.
constexpr double kExplainedShare = 0.6;

}  // namespace

std::optional<std::string> pupilHint(const calibration::Solution& solution, const calibration::SolveOptions& options,
                                     const std::vector<Eigen::Vector3d>& target_points) {
  if (solution.sigma_px < kLargeSigma_px || options.estimate_pupil_shift || options.fix_intrinsics) {
    return std::nullopt;
  }
  calibration::SolveOptions trial_options = options;
  trial_options.estimate_pupil_shift = true;
  const calibration::Solution trial = calibration::solve(
      {target_points, solution.views, solution.rig, solution.T_rig_target, solution.board_warp_m}, trial_options);
  if (trial.status != calibration::SolveStatus::kConverged || trial.sigma_px > kExplainedShare * solution.sigma_px) {
    return std::nullopt;
  }
  const std::vector<calibration::CameraStatistics> before = calibration::residualStatistics(solution, target_points);
  const std::vector<calibration::CameraStatistics> after = calibration::residualStatistics(trial, target_points);
  std::size_t most = 0;  // camera whose residuals fall by most
  for (std::size_t i = 1; i < before.size(); ++i) {
    most = before[i].rms_px - after[i].rms_px > before[most].rms_px - after[most].rms_px ? i : most;
  }
  // Where the model is too simple a moving pupil makes up for it in part, so both causes are possible.
  return cameraName(most) +
         format(
             ": residuals fall from rms %.3f to %.3f px when the entrance pupil of the lens may move: this model cannot "
             "follow the lens (%s), or the board was so near that no central model holds (record it from farther away, "
             "or add --estimate-pupil-shift for a model of far scenes)",
             before[most].rms_px, after[most].rms_px,
             richerModels(camera::modelName(solution.rig.cameras[most].camera.model)).c_str());
}

}  // namespace tartan_calib::pipeline
