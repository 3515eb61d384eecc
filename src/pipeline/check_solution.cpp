#include "check_solution.h"

#include <algorithm>

#include "tartan_calib/calibration/camera_graph.h"
#include "tartan_calib/calibration/intrinsics_uncertainty.h"
#include "tartan_calib/error.h"
#include "tartan_calib/text.h"

namespace tartan_calib::pipeline {
namespace {

/// Views in which both of two cameras have corners that the solve used.
Eigen::MatrixXi agreeingViews(const calibration::Solution& solution) {
  const auto num_cameras = static_cast<Eigen::Index>(solution.rig.cameras.size());
  Eigen::MatrixXi count = Eigen::MatrixXi::Zero(num_cameras, num_cameras);
  for (const observation::View& view : solution.views) {
    Eigen::VectorXi is_used = Eigen::VectorXi::Zero(num_cameras);
    for (const observation::CameraView& image : view.cameras) {
      is_used(image.camera_index) =
          std::any_of(image.corners.begin(), image.corners.end(), [](const auto& corner) { return corner.used; }) ? 1 : 0;
    }
    count += is_used * is_used.transpose();
  }
  return count;
}

void checkAgreement(const calibration::Solution& solution, bool is_rig_open) {
  for (std::size_t i = 0; i < solution.counts.size(); ++i) {
    if (solution.counts[i].used == 0) {
      throw CalibrationError(
          cameraName(i) +
          ": none of its corners agrees with the other cameras: check that they are in sync (inspect_bag) "
          "and fixed to each other");
    }
  }
  if (is_rig_open) {
    calibration::requireConnected(agreeingViews(solution), "views in which corners of both agree",
                                  "check that the cameras are in sync (inspect_bag) and fixed to each other");
  }
}

void checkFocalLengths(const calibration::Solution& solution) {
  constexpr double kPercent = 100.0;
  if (solution.status == calibration::SolveStatus::kConverged || solution.covariance.size() == 0) {
    return;
  }
  for (std::size_t i = 0; i < solution.rig.cameras.size(); ++i) {
    const double uncertainty_ratio = calibration::focalStdevRatio(solution, static_cast<int>(i));
    if (uncertainty_ratio > calibration::kMeaninglessFocal_ratio) {
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

}  // namespace

void checkSolution(const calibration::Solution& solution, bool is_rig_open) {
  checkAgreement(solution, is_rig_open);
  checkFocalLengths(solution);
}

}  // namespace tartan_calib::pipeline
