#include "tartan_calib/io/camchain.h"

#include <map>

#include "number_text.h"
#include "tartan_calib/camera/camera.h"
#include "tartan_calib/pipeline/warnings.h"
#include "tartan_calib/text.h"

namespace tartan_calib::io {
namespace {

constexpr const char* kIndent = "  ";

void addLine(std::string& text, const std::string& key, const std::string& value) {
  text += kIndent + key + ": " + value + "\n";
}

std::string matrixRows(const Eigen::Matrix4d& matrix) {
  std::string rows;
  for (int row = 0; row < matrix.rows(); ++row) {
    rows += std::string(kIndent) + "- " + yamlFlow(Eigen::VectorXd(matrix.row(row).transpose())) + "\n";
  }
  return rows;
}

/// Keys in alphabetical order, as PyYAML sorts them.
std::string cameraText(const Camchain& chain, std::size_t index) {
  const calibration::RigCamera& rig_camera = chain.rig.cameras[index];
  const camera::CameraModel& model = rig_camera.camera.model;
  const Eigen::VectorXd parameters = camera::parameters(model);
  const Eigen::Index num_intrinsics = camera::numIntrinsics(model);
  std::string text = cameraName(index) + ":\n";
  if (index > 0) {
    const geometry::Rigid3 T_cn_cnm1 = rig_camera.T_cam_rig * chain.rig.cameras[index - 1].T_cam_rig.inverse();
    text += std::string(kIndent) + "T_cn_cnm1:\n" + matrixRows(T_cn_cnm1.matrix());
  }
  addLine(text, "cam_overlaps", yamlFlow(chain.overlaps[index]));
  addLine(text, "camera_model", camera::kalibrModel(model));
  addLine(text, "distortion_coeffs", yamlFlow(Eigen::VectorXd(parameters.tail(parameters.size() - num_intrinsics))));
  addLine(text, "distortion_model", camera::kalibrDistortion(model));
  addLine(text, "intrinsics", yamlFlow(Eigen::VectorXd(parameters.head(num_intrinsics))));
  addLine(text, "resolution", yamlFlow(std::vector<int>{rig_camera.camera.width, rig_camera.camera.height}));
  addLine(text, "rostopic", yamlString(chain.topics[index]));
  return text;
}

}  // namespace

Camchain camchain(const pipeline::CalibrationResult& result) {
  Camchain chain;
  chain.rig = result.solution.rig;
  for (const pipeline::CameraReport& camera : result.cameras) {
    const auto index = static_cast<Eigen::Index>(chain.topics.size());
    chain.topics.push_back(camera.topic);
    std::vector<int> overlaps;
    for (Eigen::Index other = 0; other < result.graph.shared_corners.cols(); ++other) {
      if (other != index && result.graph.shared_corners(index, other) > 0) {
        overlaps.push_back(static_cast<int>(other));
      }
    }
    chain.overlaps.push_back(overlaps);
    if (const std::optional<std::string> note = pipeline::hemisphereNote(result, static_cast<int>(index))) {
      chain.comments.push_back(*note);
    }
    if (const std::optional<std::string> note = pipeline::pupilNote(result, static_cast<int>(index))) {
      chain.comments.push_back(*note);
    }
  }
  return chain;
}

std::string camchainText(const Camchain& chain) {
  std::string text;
  for (const std::string& comment : chain.comments) {
    text += "# " + comment + "\n";
  }
  std::map<std::string, std::size_t> sorted;  // as strings: cam0, cam1, cam10, cam2
  for (std::size_t index = 0; index < chain.rig.cameras.size(); ++index) {
    sorted[cameraName(index)] = index;
  }
  for (const auto& [name, index] : sorted) {
    text += cameraText(chain, index);
  }
  return text;
}

}  // namespace tartan_calib::io
