#pragma once

#include <initializer_list>
#include <string>
#include <vector>

#include "tartan_calib/pipeline/calibrate.h"

namespace tartan_calib::io {

inline Eigen::VectorXd vector(std::initializer_list<double> values) {
  return Eigen::Map<const Eigen::VectorXd>(values.begin(), static_cast<Eigen::Index>(values.size()));
}

inline camera::Camera exampleCamera(const std::string& model, std::initializer_list<double> parameters) {
  return {camera::withParameters(camera::modelByName(model), vector(parameters)), 640, 480};
}

/// A result of cameras with no views. Covariance is the identity; statistics are zero.
inline pipeline::CalibrationResult resultOf(const std::vector<calibration::RigCamera>& cameras) {
  pipeline::CalibrationResult result;
  target::AprilGrid grid;
  grid.tag_size_m = 0.088;
  grid.tag_spacing_ratio = 0.3;
  result.target = grid;
  result.solution.status = calibration::SolveStatus::kConverged;
  result.solution.rig.cameras = cameras;
  int num_rows = 6 * (static_cast<int>(cameras.size()) - 1);
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    pipeline::CameraReport report;
    report.topic = "/cam" + std::to_string(i) + "/image_raw";
    result.cameras.push_back(report);
    num_rows += camera::numParameters(cameras[i].camera.model);
  }
  const auto num_cameras = static_cast<Eigen::Index>(cameras.size());
  result.solution.counts.resize(cameras.size());
  result.solution.covariance = Eigen::MatrixXd::Identity(num_rows, num_rows);
  result.solution.sigma_px = 0.05;
  result.solution.sigma_whitened = 0.05;
  result.graph.shared_views = Eigen::MatrixXi::Ones(num_cameras, num_cameras);
  result.graph.shared_corners = Eigen::MatrixXi::Ones(num_cameras, num_cameras);
  return result;
}

}  // namespace tartan_calib::io
