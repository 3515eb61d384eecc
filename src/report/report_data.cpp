#include "tartan_calib/report/report_data.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>

#include "json.h"
#include "tartan_calib/io/atomic_file.h"
#include "tartan_calib/io/results_text.h"
#include "tartan_calib/text.h"

namespace tartan_calib::report {
namespace {

constexpr double kDegreesPerRadian = 180.0 / M_PI;
constexpr double kNsPerMs = 1e6;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

double degrees(const std::optional<double>& angle_rad) { return angle_rad ? *angle_rad * kDegreesPerRadian : kNan; }

/// Rows of doubles with named columns, in a file of their own.
class Table {
 public:
  Table(std::string file, std::vector<std::string> columns) : file_(std::move(file)), columns_(std::move(columns)) {}

  void addRow(const std::vector<double>& row) { values_.insert(values_.end(), row.begin(), row.end()); }

  /// Writes the file and tells what describes it.
  std::string write(const std::string& folder) const {
    const auto* bytes = reinterpret_cast<const char*>(values_.data());  // doubles are their bytes
    io::writeFile(folder + "/" + file_, {bytes, values_.size() * sizeof(double)});
    return JsonObject().add("file", file_).add("columns", columns_).text();
  }

 private:
  std::string file_;
  std::vector<std::string> columns_;
  std::vector<double> values_;
};

Table foundTable(const std::string& name, const SeenCorners& corners) {
  Table table(name + "-found.f64",
              {"view", "corner", "u_px", "v_px", "du_px", "dv_px", "polar_deg", "azimuth_deg", "used", "round"});
  for (const FoundCorner& corner : corners.found) {
    const Eigen::Vector2d residual_px = corner.residual_px.value_or(Eigen::Vector2d(kNan, kNan));
    table.addRow({static_cast<double>(corner.view), static_cast<double>(corner.corner_id), corner.px.x(), corner.px.y(),
                  residual_px.x(), residual_px.y(), degrees(corner.polar_rad), corner.azimuth_rad * kDegreesPerRadian,
                  corner.used ? 1.0 : 0.0, static_cast<double>(corner.round)});
  }
  return table;
}

Table missedTable(const std::string& name, const SeenCorners& corners) {
  Table table(name + "-missed.f64", {"view", "corner", "u_px", "v_px", "polar_deg"});
  for (const MissedCorner& corner : corners.missed) {
    table.addRow({static_cast<double>(corner.view), static_cast<double>(corner.corner_id), corner.px.x(), corner.px.y(),
                  degrees(corner.polar_rad)});
  }
  return table;
}

Table mapTable(const std::string& name, const ProjectionMap& map) {
  Table table(name + "-map.f64", {"u_px", "v_px", "polar_deg", "seen", "stdev_px", "difference_px"});
  for (const MapSample& sample : map.samples) {
    table.addRow({sample.px.x(), sample.px.y(), degrees(sample.polar_rad), sample.is_seen ? 1.0 : 0.0,
                  sample.stdev_px.value_or(kNan), sample.difference_px.value_or(kNan)});
  }
  return table;
}

/// Radius of the image over the angle from the axis, in all directions' mean, as far as the model goes inside of the image's
/// diagonal.
Table curveTable(const std::string& name, const camera::Camera& camera) {
  constexpr double kStep_deg = 0.5;
  constexpr int kDirections = 8;
  const double diagonal_px = std::hypot(camera.width, camera.height);
  const auto centre_px = camera::project(camera.model, Eigen::Vector3d::UnitZ());
  Table table(name + "-curve.f64", {"angle_deg", "radius_px"});
  for (double angle_deg = 0.0; angle_deg < 180.0; angle_deg += kStep_deg) {
    const double polar_rad = angle_deg / kDegreesPerRadian;
    double radius_px = 0.0;
    for (int i = 0; i < kDirections; ++i) {
      const double azimuth_rad = 2.0 * M_PI * i / kDirections;
      const Eigen::Vector3d ray(std::sin(polar_rad) * std::cos(azimuth_rad), std::sin(polar_rad) * std::sin(azimuth_rad),
                                std::cos(polar_rad));
      const auto px = camera::project(camera.model, ray);
      radius_px += px ? (*px - *centre_px).norm() / kDirections : kNan;
    }
    if (!(radius_px <= 0.5 * diagonal_px)) {
      break;
    }
    table.addRow({angle_deg, radius_px});
  }
  return table;
}

std::string pictureText(const Picture& picture) {
  return JsonObject()
      .add("view", picture.view)
      .add("file", picture.file)
      .add("origin_px", Eigen::MatrixXd(picture.origin_px.cast<double>().transpose()))
      .add("scale", picture.scale)
      .text();
}

std::string biasText(const RadialBias& bias) {
  return JsonObject()
      .add("from_deg", bias.from_rad * kDegreesPerRadian)
      .add("to_deg", bias.to_rad * kDegreesPerRadian)
      .add("mean_px", bias.mean_px)
      .add("stdev_px", bias.stdev_px)
      .text();
}

std::string bandText(const calibration::PolarBand& band) {
  return JsonObject()
      .add("from_deg", band.from_rad * kDegreesPerRadian)
      .add("to_deg", band.to_rad * kDegreesPerRadian)
      .add("corners", band.num_corners)
      .add("rms_px", band.rms_px)
      .text();
}

std::string statisticsText(const calibration::CameraStatistics& statistics) {
  return JsonObject()
      .add("views", statistics.num_views)
      .add("corners", statistics.num_corners)
      .add("rms_px", statistics.rms_px)
      .add("median_px", statistics.median_px)
      .add("max_polar_deg", statistics.max_polar_angle_rad * kDegreesPerRadian)
      .addText("bands", jsonListOf(statistics.bands, bandText))
      .text();
}

std::string cameraText(const std::string& folder, const ReportData& data, std::size_t index) {
  const std::string name = cameraName(index);
  const calibration::RigCamera& rig_camera = data.result.solution.rig.cameras[index];
  const CameraAnalysis& analysis = data.analysis.cameras[index];
  JsonObject object;
  object.add("name", name)
      .add("topic", data.result.cameras[index].topic)
      .add("model", camera::modelName(rig_camera.camera.model))
      .add("width", rig_camera.camera.width)
      .add("height", rig_camera.camera.height)
      .add("T_rig_cam", Eigen::MatrixXd(rig_camera.T_cam_rig.inverse().matrix()))
      .addText("statistics", statisticsText(data.result.cameras[index].statistics))
      .addText("found", foundTable(name, analysis.corners).write(folder))
      .addText("missed", missedTable(name, analysis.corners).write(folder))
      .addText("map", mapTable(name, analysis.map).write(folder))
      .add("map_rows", analysis.map.rows)
      .addText("curve", curveTable(name, rig_camera.camera).write(folder))
      .add("reach_deg", analysis.reach_rad * kDegreesPerRadian)
      .add("focal_stdev_ratio", analysis.focal_stdev_ratio)
      .add("median_stdev_px", analysis.median_stdev_px)
      .add("median_difference_px", analysis.median_difference_px)
      .add("median_expected_difference_px", analysis.median_expected_difference_px)
      .addText("radial_biases", jsonListOf(analysis.radial_biases, biasText));
  const bool has_pictures = index < data.pictures.size();
  object.addText("frames", has_pictures ? jsonListOf(data.pictures[index].frames, pictureText) : "[]");
  object.addText("worst", has_pictures ? jsonListOf(data.pictures[index].worst, pictureText) : "[]");
  return object.text();
}

std::string verdictText(const Verdict& verdict) {
  const auto reason = [](const Reason& item) {
    return JsonObject().add("grade", gradeName(item.grade)).add("text", item.text).text();
  };
  return JsonObject()
      .add("grade", gradeName(verdict.grade))
      .add("facts", verdict.facts)
      .addText("reasons", jsonListOf(verdict.reasons, reason))
      .text();
}

std::string roundText(const pipeline::RoundSummary& round) {
  return JsonObject()
      .add("round", round.round)
      .add("corners", round.corners)
      .add("gained", round.gained)
      .add("lost", round.lost)
      .add("rms_px", round.rms_px)
      .text();
}

std::string timingText(const CameraTiming& timing) {
  return JsonObject()
      .add("camera", timing.camera_index)
      .add("stamps_ms", timing.median_stamp_ns / kNsPerMs)
      .add("delay_ms", timing.delay_ns / kNsPerMs)
      .add("delay_stdev_ms", timing.delay_stdev_ns / kNsPerMs)
      .text();
}

std::string viewsText(const calibration::Solution& solution) {
  std::vector<std::string> views;
  for (std::size_t i = 0; i < solution.views.size(); ++i) {
    views.push_back(JsonObject()
                        .addText("stamp_ns", std::to_string(solution.views[i].stamp_ns))
                        .add("T_rig_target", Eigen::MatrixXd(solution.T_rig_target[i].matrix()))
                        .text());
  }
  return jsonList(views);
}

std::string boardText(const pipeline::CalibrationResult& result) {
  const std::vector<Eigen::Vector3d> points = target::cornerPoints(result.target);
  Eigen::MatrixXd rows(static_cast<Eigen::Index>(points.size()), 3);
  for (std::size_t i = 0; i < points.size(); ++i) {
    rows.row(static_cast<Eigen::Index>(i)) = points[i].transpose();
  }
  return json(rows);
}

/// Warnings that the verdict does not state already.
std::vector<std::string> notes(const ReportData& data) {
  const std::vector<Reason>& reasons = data.verdict.reasons;
  std::vector<std::string> notes;
  std::copy_if(
      data.result.warnings.begin(), data.result.warnings.end(), std::back_inserter(notes), [&](const std::string& warning) {
        return std::none_of(reasons.begin(), reasons.end(),
                            [&](const Reason& reason) { return reason.text == warning || reason.warning == warning; });
      });
  return notes;
}

}  // namespace

void writeReportData(const std::string& folder, const ReportData& data) {
  const pipeline::CalibrationResult& result = data.result;
  std::vector<std::string> cameras;
  for (std::size_t i = 0; i < result.cameras.size(); ++i) {
    cameras.push_back(cameraText(folder, data, i));
  }
  JsonObject object;
  object.add("recording", data.recording)
      .addText("verdict", verdictText(data.verdict))
      .add("results_text", io::resultsText(result))
      .add("warnings", notes(data))
      .addText("rounds", jsonListOf(result.rounds, roundText))
      .addText("timings", jsonListOf(data.analysis.timings, timingText))
      .add("shared_corners", Eigen::MatrixXd(result.graph.shared_corners.cast<double>()))
      .add("shared_views", Eigen::MatrixXd(result.graph.shared_views.cast<double>()))
      .addText("board_m", boardText(result))
      .addText("views", viewsText(result.solution))
      .addText("cameras", jsonList(cameras));
  io::writeFile(folder + "/data.json", object.text() + "\n");
}

}  // namespace tartan_calib::report
