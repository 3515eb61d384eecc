#include "check_solution.h"

#include <cmath>

#include "tartan_calib/error.h"
#include "tartan_calib/text.h"

namespace tartan_calib::pipeline {
namespace {

/// Stdev of a focal length over the focal length. Usable calibrations stay below 0.01; those of too few views below 0.1.
constexpr double kMeaninglessFocal_ratio = 0.2;

/// The larger one of fu and fv.
double focalUncertainty(const calibration::Solution& solution, int camera_index) {
  constexpr int kNumFocal = 2;
  const camera::CameraModel& model = solution.rig.cameras[static_cast<std::size_t>(camera_index)].camera.model;
  const int focal = camera::focalIndex(model);
  const Eigen::VectorXd parameters = camera::parameters(model);
  const int row = calibration::intrinsicsRow(solution.rig, camera_index) + focal;
  double largest = 0.0;
  for (int i = 0; i < kNumFocal; ++i) {
    const double variance_px2 = std::max(0.0, solution.covariance(row + i, row + i));
    largest = std::max(largest, std::sqrt(variance_px2) / std::abs(parameters(focal + i)));
  }
  return largest;
}

}  // namespace

void checkSolution(const calibration::Solution& solution) {
  constexpr double kPercent = 100.0;
  if (solution.status == calibration::SolveStatus::kConverged || solution.covariance.size() == 0) {
    return;
  }
  for (std::size_t i = 0; i < solution.rig.cameras.size(); ++i) {
    const double uncertainty_ratio = focalUncertainty(solution, static_cast<int>(i));
    if (uncertainty_ratio > kMeaninglessFocal_ratio) {
      throw CalibrationError(
          cameraName(i) +
          format(": the solver did not converge, and the focal length is uncertain to %.0f %%: the views do not determine "
                 "a calibration; check the target file%s, record the board at more angles and distances, or try another of "
                 "--models",
                 kPercent * uncertainty_ratio,
                 solution.rig.cameras.size() > 1 ? " and that the cameras are in sync (inspect_bag)" : ""));
    }
  }
}

}  // namespace tartan_calib::pipeline
