#include "check_solution.h"

#include <algorithm>

#include "tartan_calib/calibration/camera_graph.h"
#include "tartan_calib/calibration/intrinsics_uncertainty.h"
#include "tartan_calib/error.h"
#include "tartan_calib/text.h"

namespace tartan_calib::pipeline {
namespace {

/// The views with only those corners that the solve used.
std::vector<observation::View> usedViews(const calibration::Solution& solution) {
  std::vector<observation::View> views = solution.views;
  for (observation::View& view : views) {
    for (observation::CameraView& image : view.cameras) {
      auto& corners = image.corners;
      corners.erase(std::remove_if(corners.begin(), corners.end(), [](const auto& corner) { return !corner.used; }),
                    corners.end());
    }
  }
  return views;
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
    const int num_cameras = static_cast<int>(solution.rig.cameras.size());
    calibration::requireConnected(calibration::cameraGraph(usedViews(solution), num_cameras).shared_views,
                                  "views in which corners of both agree",
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
