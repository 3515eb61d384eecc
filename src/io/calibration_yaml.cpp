#include "tartan_calib/io/calibration_yaml.h"
#include "tartan_calib/text.h"

#include "calibration_options_yaml.h"
#include "number_text.h"
#include "yaml_writer.h"

namespace tartan_calib::io {
namespace {

using calibration::SolveStatus;
using pipeline::CalibrationResult;

constexpr double kDegreesPerRadian = 180.0 / 3.14159265358979323846;

std::string statusName(SolveStatus status) {
  switch (status) {
    case SolveStatus::kConverged:
      return "converged";
    case SolveStatus::kMaxIterations:
      return "max_iterations";
    case SolveStatus::kStalled:
      return "stalled";
    case SolveStatus::kCancelled:
      return "cancelled";
  }
  return "";
}

/// [qw, qx, qy, qz, tx, ty, tz], Hamilton.
std::string poseFlow(const geometry::Rigid3& T) {
  Eigen::VectorXd values(7);
  values << T.rotation.w(), T.rotation.x(), T.rotation.y(), T.rotation.z(), T.translation;
  return yamlFlow(values);
}

void addRun(YamlWriter& yaml, const RunInfo& run) {
  yaml.open("run");
  yaml.add("recording", yamlString(run.recording));
  yaml.add("target_file", yamlString(run.target_file));
  yaml.add("command", yamlString(run.command));
  yaml.close();
}

void addSolution(YamlWriter& yaml, const CalibrationResult& result) {
  const calibration::Solution& solution = result.solution;
  yaml.open("solution");
  yaml.add("status", statusName(solution.status));
  yaml.add("iterations", std::to_string(solution.iterations));
  yaml.add("num_views", std::to_string(solution.views.size()));
  yaml.add("num_dropped_views", std::to_string(result.num_dropped_views));
  yaml.add("sigma_px", yamlFloat(solution.sigma_px));
  yaml.add("sigma_whitened", yamlFloat(solution.sigma_whitened));
  yaml.add("board_warp_m", yamlFlow(Eigen::VectorXd(solution.board_warp_m)));
  yaml.add("undetermined", yamlFlow(solution.undetermined));
  yaml.close();
}

void addRounds(YamlWriter& yaml, const std::vector<pipeline::RoundSummary>& rounds) {
  yaml.open("rounds");
  for (const pipeline::RoundSummary& round : rounds) {
    yaml.item("{round: " + std::to_string(round.round) + ", corners: " + std::to_string(round.corners) +
              ", gained: " + std::to_string(round.gained) + ", lost: " + std::to_string(round.lost) +
              ", rms_px: " + yamlFloat(round.rms_px) + ", model_change_px: " + yamlFloat(round.model_change_px) + "}");
  }
  yaml.close();
}

void addCounts(YamlWriter& yaml, const pipeline::CameraReport& report, const calibration::CornerCounts& corners) {
  const detection::DetectionCounts& tags = report.counts;
  yaml.open("images");
  yaml.add("total", std::to_string(report.num_images));
  yaml.add("detected", std::to_string(report.num_images_detected));
  yaml.add("used", std::to_string(report.num_images_used));
  yaml.close();
  yaml.open("tags");
  yaml.add("found", std::to_string(tags.tags));
  yaml.add("duplicate", std::to_string(tags.duplicate_tags));
  yaml.add("foreign", std::to_string(tags.foreign_tags));
  yaml.add("mirrored", std::to_string(tags.mirrored_tags));
  yaml.add("other_border", std::to_string(tags.other_border_tags));
  yaml.close();
  yaml.open("corners");
  yaml.add("used", std::to_string(corners.used));
  yaml.add("outliers", std::to_string(corners.outliers));
  yaml.add("unprojectable", std::to_string(corners.unprojectable));
  yaml.add("unsupported", std::to_string(corners.unsupported));
  yaml.close();
}

void addResiduals(YamlWriter& yaml, const calibration::CameraStatistics& statistics) {
  yaml.open("residuals");
  yaml.add("mean_px", yamlFlow(Eigen::VectorXd(statistics.mean_px)));
  yaml.add("stdev_px", yamlFlow(Eigen::VectorXd(statistics.stdev_px)));
  yaml.add("rms_px", yamlFloat(statistics.rms_px));
  yaml.add("median_px", yamlFloat(statistics.median_px));
  yaml.add("max_polar_angle_deg", yamlFloat(statistics.max_polar_angle_rad * kDegreesPerRadian));
  yaml.open("bands");
  for (const calibration::PolarBand& band : statistics.bands) {
    yaml.item("{from_deg: " + fixedText(band.from_rad * kDegreesPerRadian, 1) +
              ", to_deg: " + fixedText(band.to_rad * kDegreesPerRadian, 1) +
              ", corners: " + std::to_string(band.num_corners) + ", rms_px: " + yamlFloat(band.rms_px) + "}");
  }
  yaml.close();
  yaml.close();
}

void addCamera(YamlWriter& yaml, const CalibrationResult& result, std::size_t index) {
  const calibration::RigCamera& rig_camera = result.solution.rig.cameras[index];
  const pipeline::CameraReport& report = result.cameras[index];
  const Eigen::VectorXd parameters = camera::parameters(rig_camera.camera.model);
  const Eigen::Index num_intrinsics = camera::numIntrinsics(rig_camera.camera.model);
  yaml.open(cameraName(index));
  yaml.add("topic", yamlString(report.topic));
  yaml.add("model", camera::modelName(rig_camera.camera.model));
  yaml.add("resolution", yamlFlow(std::vector<int>{rig_camera.camera.width, rig_camera.camera.height}));
  yaml.add("intrinsics", yamlFlow(Eigen::VectorXd(parameters.head(num_intrinsics))));
  yaml.add("distortion_coeffs", yamlFlow(Eigen::VectorXd(parameters.tail(parameters.size() - num_intrinsics))));
  yaml.add("pupil_shift_m", yamlFlow(Eigen::VectorXd(rig_camera.camera.pupil.coefficients_m)));
  yaml.add("T_cam_rig", poseFlow(rig_camera.T_cam_rig));
  addCounts(yaml, report, result.solution.counts[index]);
  addResiduals(yaml, report.statistics);
  yaml.close();
}

void addRows(YamlWriter& yaml, const std::string& key, const Eigen::MatrixXi& matrix) {
  yaml.open(key);
  for (Eigen::Index row = 0; row < matrix.rows(); ++row) {
    const Eigen::VectorXi values = matrix.row(row).transpose();
    yaml.item(yamlFlow(std::vector<int>(values.data(), values.data() + values.size())));
  }
  yaml.close();
}

/// Names of the covariance's rows.
std::vector<std::string> covarianceNames(const calibration::Solution& solution, const calibration::SolveOptions& options) {
  std::vector<std::string> names;
  const auto& cameras = solution.rig.cameras;
  for (std::size_t i = 1; i < cameras.size(); ++i) {
    const std::string baseline = "T_" + std::to_string(i) + "_" + std::to_string(i - 1);
    for (const char* part : {"rx_rad", "ry_rad", "rz_rad", "x_m", "y_m", "z_m"}) {
      names.push_back(baseline + "." + part);
    }
  }
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    const int num_intrinsics = camera::numIntrinsics(cameras[i].camera.model);
    for (int k = 0; k < camera::numParameters(cameras[i].camera.model); ++k) {
      const bool is_intrinsic = k < num_intrinsics;
      names.push_back(cameraName(i) + (is_intrinsic ? ".intrinsics." : ".distortion_coeffs.") +
                      std::to_string(is_intrinsic ? k : k - num_intrinsics));
    }
  }
  for (int k = 0; options.estimate_board_warp && k < 2; ++k) {
    names.push_back("board_warp_m." + std::to_string(k));
  }
  for (std::size_t i = 0; options.estimate_pupil_shift && i < cameras.size(); ++i) {
    for (int k = 0; k < camera::PupilShift::kNumParameters; ++k) {
      names.push_back(cameraName(i) + ".pupil_shift_m." + std::to_string(k));
    }
  }
  return names;
}

void addCovariance(YamlWriter& yaml, const calibration::Solution& solution, const calibration::SolveOptions& options) {
  yaml.open("covariance");
  yaml.comment("scaled by sigma_whitened^2; rotations: R <- exp(r) R");
  const bool is_known = solution.covariance.size() > 0;
  yaml.add("parameters", yamlFlow(is_known ? covarianceNames(solution, options) : std::vector<std::string>()));
  yaml.open("matrix");
  for (Eigen::Index row = 0; row < solution.covariance.rows(); ++row) {
    yaml.item(yamlFlow(Eigen::VectorXd(solution.covariance.row(row).transpose())));
  }
  yaml.close();
  yaml.close();
}

void addViews(YamlWriter& yaml, const calibration::Solution& solution) {
  yaml.comment("T_rig_target: [qw, qx, qy, qz, tx, ty, tz], Hamilton, metres");
  yaml.open("views");
  for (std::size_t i = 0; i < solution.views.size(); ++i) {
    std::vector<int> cameras;
    for (const observation::CameraView& image : solution.views[i].cameras) {
      cameras.push_back(image.camera_index);
    }
    yaml.item("{stamp_ns: " + std::to_string(solution.views[i].stamp_ns) + ", cameras: " + yamlFlow(cameras) +
              ", T_rig_target: " + poseFlow(solution.T_rig_target[i]) + "}");
  }
  yaml.close();
}

}  // namespace

std::string calibrationText(const CalibrationResult& result, const pipeline::CalibrateOptions& options, const RunInfo& run) {
  YamlWriter yaml;
  yaml.add("tartan_calib_version", yamlString("v" TARTAN_CALIB_VERSION));
  addRun(yaml, run);
  addOptions(yaml, options, result.target);
  addTarget(yaml, result.target);
  addSolution(yaml, result);
  addRounds(yaml, result.rounds);
  yaml.open("cameras");
  for (std::size_t i = 0; i < result.cameras.size(); ++i) {
    addCamera(yaml, result, i);
  }
  yaml.close();
  yaml.open("graph");
  addRows(yaml, "shared_views", result.graph.shared_views);
  addRows(yaml, "shared_corners", result.graph.shared_corners);
  yaml.close();
  addCovariance(yaml, result.solution, options.solve);
  yaml.add("warnings", yamlFlow(result.warnings));
  addViews(yaml, result.solution);
  return yaml.text();
}

}  // namespace tartan_calib::io
