#include "tartan_calib/io/results_text.h"
#include "tartan_calib/text.h"

#include <cmath>
#include <limits>
#include <map>

#include "number_text.h"

namespace tartan_calib::io {
namespace {

using pipeline::CalibrationResult;

/// Kalibr prints Python's name of its own class; scripts read the model from it.
std::string kalibrClass(const camera::CameraModel& model) {
  static const std::map<std::string, std::string> shapes = {
      {"pinhole", "Pinhole"}, {"omni", "Omni"}, {"eucm", "ExtendedUnified"}, {"ds", "DoubleSphere"}};
  static const std::map<std::string, std::string> distortions = {
      {"none", ""}, {"radtan", "Distorted"}, {"equidistant", "EquidistantDistorted"}, {"fov", "FovDistorted"}};
  const auto shape = shapes.find(camera::kalibrModel(model));
  const auto distortion = distortions.find(camera::kalibrDistortion(model));
  if (shape == shapes.end() || distortion == distortions.end()) {
    return camera::modelName(model);  // a model that Kalibr does not have
  }
  return "<class 'aslam_cv.libaslam_cv_python." + distortion->second + shape->second + "CameraGeometry'>";
}

/// Square roots of `count` diagonal elements; nan where the covariance is unknown.
Eigen::VectorXd stdevs(const calibration::Solution& solution, int first_row, Eigen::Index count) {
  if (solution.covariance.size() == 0) {
    return Eigen::VectorXd::Constant(count, std::numeric_limits<double>::quiet_NaN());
  }
  return solution.covariance.diagonal().segment(first_row, count).cwiseMax(0.0).cwiseSqrt();
}

std::string withStdev(const Eigen::VectorXd& values, const Eigen::VectorXd& stdev) {
  return arrayText(values) + " +- " + arrayText(stdev) + "\n";
}

std::string pair(const Eigen::Vector2d& values) {
  constexpr int kDecimals = 6;
  return "[" + fixedText(values.x(), kDecimals) + ", " + fixedText(values.y(), kDecimals) + "]";
}

std::string cameraBlock(const CalibrationResult& result, int index) {
  const auto at = static_cast<std::size_t>(index);
  const camera::CameraModel& model = result.solution.rig.cameras[at].camera.model;
  const calibration::CameraStatistics& statistics = result.cameras[at].statistics;
  const Eigen::VectorXd parameters = camera::parameters(model);
  const Eigen::VectorXd stdev =
      stdevs(result.solution, calibration::intrinsicsRow(result.solution.rig, index), parameters.size());
  const Eigen::Index num_intrinsics = camera::numIntrinsics(model);
  const Eigen::Index num_distortion = parameters.size() - num_intrinsics;
  std::string text = cameraName(index) + " (" + result.cameras[at].topic + "):\n";
  text += "    type: " + kalibrClass(model) + "\n";
  text += "    distortion: " + withStdev(parameters.tail(num_distortion), stdev.tail(num_distortion));
  text += "    projection: " + withStdev(parameters.head(num_intrinsics), stdev.head(num_intrinsics));
  text += "    reprojection error: " + pair(statistics.mean_px) + " +- " + pair(statistics.stdev_px) + "\n\n";
  return text;
}

/// JPL's quaternion x, y, z, w with w >= 0: the conjugate of Hamilton's.
Eigen::Vector4d jplQuaternion(const Eigen::Quaterniond& hamilton) {
  const double sign = hamilton.w() < 0.0 ? -1.0 : 1.0;
  Eigen::Vector4d xyzw;
  xyzw << -sign * hamilton.vec(), sign * hamilton.w();
  return xyzw;
}

std::string baselineBlock(const calibration::Solution& solution, int index) {
  const auto at = static_cast<std::size_t>(index);
  const geometry::Rigid3 T = solution.rig.cameras[at].T_cam_rig * solution.rig.cameras[at - 1].T_cam_rig.inverse();
  const Eigen::VectorXd stdev = stdevs(solution, calibration::baselineRow(index), 6);
  std::string text = "baseline T_" + std::to_string(index) + "_" + std::to_string(index - 1) + ":\n";
  text += "    q: " + withStdev(jplQuaternion(T.rotation), stdev.head(3));
  text += "    t: " + withStdev(T.translation, stdev.tail(3)) + "\n";
  return text;
}

struct TargetBlock {
  std::string operator()(const target::AprilGrid& grid) const {
    return "  Type: aprilgrid\n  Tags: \n    Rows: " + std::to_string(grid.tag_rows) +
           "\n    Cols: " + std::to_string(grid.tag_cols) + "\n    Size: " + pythonFloat(grid.tag_size_m) +
           " [m]\n    Spacing " + pythonFloat(grid.tag_size_m * grid.tag_spacing_ratio) + " [m]\n";
  }
  std::string operator()(const target::Checkerboard& board) const {
    return "  Type: checkerboard\n  Rows\n    Count: " + std::to_string(board.rows) +
           "\n    Distance: " + pythonFloat(board.row_spacing_m) + " [m]\n  Cols\n    Count: " + std::to_string(board.cols) +
           "\n    Distance: " + pythonFloat(board.col_spacing_m) + " [m]\n";
  }
  std::string operator()(const target::CircleGrid& /*grid*/) const { return "  Type: circlegrid\n"; }
};

/// Not among Kalibr's lines: it knows flat boards only.
std::string warpLine(const calibration::Solution& solution) {
  if (solution.board_warp_m.isZero()) {
    return "";
  }
  const int row = calibration::intrinsicsRow(solution.rig, static_cast<int>(solution.rig.cameras.size()));
  return "  Warp [m]: " + withStdev(solution.board_warp_m, stdevs(solution, row, solution.board_warp_m.size()));
}

}  // namespace

std::string resultsText(const CalibrationResult& result) {
  const int num_cameras = static_cast<int>(result.solution.rig.cameras.size());
  std::string text = "Calibration results \n====================\nCamera-system parameters:\n";
  for (int index = 0; index < num_cameras; ++index) {
    text += cameraBlock(result, index);
  }
  for (int index = 1; index < num_cameras; ++index) {
    text += baselineBlock(result.solution, index);
  }
  text += "\n\nTarget configuration\n====================\n\n";
  text += std::visit(TargetBlock{}, result.target) + warpLine(result.solution);
  return text + "\n# '+-' is one standard deviation, scaled by the residuals' (" + fixedText(result.solution.sigma_px, 6) +
         " px); Kalibr prints it for residuals of 1 px.\n";
}

}  // namespace tartan_calib::io
