#include "observations.h"

#include <Eigen/Cholesky>
#include <string>

#include "tartan_calib/error.h"

namespace tartan_calib::calibration {
namespace {

[[noreturn]] void failAt(std::size_t view, int camera_index, const std::string& what) {
  throw InputError("view " + std::to_string(view) + ", cam" + std::to_string(camera_index) + ": " + what);
}

Measurement measurementOf(const observation::Corner& corner) {
  return {corner.corner_id, corner.px, corner.cov_px2, sqrtInformation(corner.cov_px2), CornerState::kUsed};
}

void check(const Problem& problem, const observation::CameraView& image, std::size_t view) {
  if (image.camera_index < 0 || image.camera_index >= static_cast<int>(problem.rig.cameras.size())) {
    failAt(view, image.camera_index, "the rig has " + std::to_string(problem.rig.cameras.size()) + " cameras");
  }
  const auto name = [](const observation::Corner& corner) { return "corner " + std::to_string(corner.corner_id); };
  for (const observation::Corner& corner : image.corners) {
    if (corner.corner_id < 0 || corner.corner_id >= static_cast<int>(problem.target_points.size())) {
      failAt(view, image.camera_index,
             name(corner) + " is not on the target; it has ids below " + std::to_string(problem.target_points.size()));
    }
    if (!corner.px.allFinite()) {
      failAt(view, image.camera_index, name(corner) + " has a position that is not finite");
    }
    if (!corner.cov_px2.allFinite() || !(corner.cov_px2(0, 0) > 0.0) || !(corner.cov_px2.determinant() > 0.0)) {
      failAt(view, image.camera_index, name(corner) + " has a covariance that is not positive definite");
    }
  }
}

}  // namespace

Eigen::Matrix2d sqrtInformation(const Eigen::Matrix2d& cov) {
  // inverse(L L') = inverse(L)' inverse(L).
  return Eigen::LLT<Eigen::Matrix2d>(cov).matrixL().solve(Eigen::Matrix2d::Identity());
}

std::vector<ViewMeasurements> measurementsOf(const Problem& problem) {
  if (problem.T_rig_target.size() != problem.views.size()) {
    throw InputError(std::to_string(problem.views.size()) + " views with " + std::to_string(problem.T_rig_target.size()) +
                     " board poses; each view needs one");
  }
  std::vector<ViewMeasurements> views;
  std::size_t num_corners = 0;
  for (std::size_t k = 0; k < problem.views.size(); ++k) {
    ViewMeasurements& view = views.emplace_back();
    for (const observation::CameraView& image : problem.views[k].cameras) {
      check(problem, image, k);
      CameraMeasurements& measurements = view.emplace_back();
      measurements.camera_index = image.camera_index;
      for (const observation::Corner& corner : image.corners) {
        measurements.corners.push_back(measurementOf(corner));
      }
      num_corners += image.corners.size();
    }
  }
  if (num_corners == 0) {
    throw CalibrationError("no corners in any of " + std::to_string(problem.views.size()) +
                           " views; nothing can be calibrated");
  }
  return views;
}

}  // namespace tartan_calib::calibration
