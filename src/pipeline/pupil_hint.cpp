#include "pupil_hint.h"

#include <algorithm>

#include "tartan_calib/text.h"

namespace tartan_calib::pipeline {
namespace {

/// Stdev of a residual's component above which a lens model is worth a second look.
constexpr double kLargeSigma_px = 0.2;
/// A moving pupil that leaves more than this share of the residuals is not what is wrong.
constexpr double kExplainedShare = 0.6;

/// Where the model is too simple a moving pupil makes up for it in part, so both causes are possible. The models that follow
/// nearly every lens, but for those that were used.
std::string modelsToTry(const calibration::Rig& rig) {
  std::vector<std::string> models = {"ds-none", "pinhole-equi"};
  for (const calibration::RigCamera& camera : rig.cameras) {
    const auto used = std::find(models.begin(), models.end(), camera::modelName(camera.camera.model));
    if (models.size() > 1 && used != models.end()) {
      models.erase(used);
    }
  }
  return joined(models, " or ");
}

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
  return format(
      "residuals fall from %.2f to %.2f px when the entrance pupil of the lens may move: this model cannot follow the lens "
      "(try %s), or the board was so near that no central model holds (record it from farther away, or add "
      "--estimate-pupil-shift for a model of far scenes)",
      solution.sigma_px, trial.sigma_px, modelsToTry(solution.rig).c_str());
}

}  // namespace tartan_calib::pipeline
