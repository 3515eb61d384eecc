#include <algorithm>
#include <cmath>
#include <utility>

#include "read_file.h"
#include "tartan_calib/error.h"
#include "tartan_calib/io/camchain.h"
#include "tartan_calib/text.h"
#include "yaml_reader.h"

namespace tartan_calib::io {
namespace {

/// Largest deviation of R R^T from the identity: files that were typed off with few digits pass, wrong matrices do not.
constexpr double kOrthonormal = 1e-2;
constexpr int kMaxResolution = 100000;
constexpr Eigen::Index kMatrixSize = 4;

/// One camera's keys, with messages that say file, camera and key.
class CameraReader {
 public:
  CameraReader(const YAML::Node& map, std::string name, std::string camera)
      : map_(map), name_(std::move(name)), camera_(std::move(camera)) {
    if (!map_.IsMap()) {
      throw InputError(yamlPlace(name_, map_) + ": " + camera_ + ": expected the keys of a camera");
    }
  }

  camera::Camera camera() const {
    const camera::CameraModel kind = model();
    const Eigen::Index num_intrinsics = camera::numIntrinsics(kind);
    const Eigen::Index num_parameters = camera::numParameters(kind);
    Eigen::VectorXd parameters(num_parameters);
    parameters << numbers("intrinsics", num_intrinsics), numbers("distortion_coeffs", num_parameters - num_intrinsics);
    checkRange(kind, parameters);
    const std::optional<std::vector<int>> size = yamlInts(required("resolution"));
    if (!size || size->size() != 2 || !isSize((*size)[0]) || !isSize((*size)[1])) {
      reject("resolution", "[width, height] in pixels");
    }
    return {camera::withParameters(kind, parameters), (*size)[0], (*size)[1]};
  }

  geometry::Rigid3 baseline() const {
    const YAML::Node rows = required("T_cn_cnm1");
    Eigen::Matrix4d matrix;
    const bool has_rows = rows.IsSequence() && rows.size() == kMatrixSize;
    for (Eigen::Index row = 0; row < kMatrixSize; ++row) {
      const auto values = has_rows ? yamlNumbers(rows[static_cast<std::size_t>(row)]) : std::nullopt;
      if (!values || values->size() != kMatrixSize) {
        reject("T_cn_cnm1", "4 rows of 4 numbers");
      }
      matrix.row(row) = Eigen::RowVector4d(values->data());
    }
    const Eigen::Matrix3d R = matrix.topLeftCorner<3, 3>();
    const bool is_rotation = (R * R.transpose()).isIdentity(kOrthonormal) && R.determinant() > 0.0;
    if (!is_rotation || !matrix.row(3).isApprox(Eigen::RowVector4d(0.0, 0.0, 0.0, 1.0))) {
      reject("T_cn_cnm1", "a rotation and a translation, last row [0, 0, 0, 1]");
    }
    return geometry::rigidFromMatrix(matrix);
  }

  bool hasBaseline() const { return map_["T_cn_cnm1"].IsDefined(); }

  std::string topic() const { return map_["rostopic"].IsDefined() ? text("rostopic") : ""; }

  std::vector<int> overlaps() const {
    if (!map_["cam_overlaps"].IsDefined()) {
      return {};
    }
    const std::optional<std::vector<int>> cameras = yamlInts(map_["cam_overlaps"]);
    if (!cameras) {
      reject("cam_overlaps", "a list of camera indices");
    }
    return *cameras;
  }

 private:
  static bool isSize(int pixels) { return pixels > 0 && pixels <= kMaxResolution; }

  camera::CameraModel model() const {
    const std::string camera_model = text("camera_model");
    const std::string distortion_model = text("distortion_model");
    try {
      return camera::modelByKalibrNames(camera_model, distortion_model);
    } catch (const InputError& error) {
      throw InputError(yamlPlace(name_, map_["camera_model"]) + ": " + camera_ + ": " + error.what());
    }
  }

  YAML::Node required(const std::string& key) const {
    const YAML::Node node = map_[key];
    if (!node.IsDefined()) {
      throw InputError(yamlPlace(name_, map_) + ": " + camera_ + ": the key '" + key + "' is missing");
    }
    return node;
  }

  std::string text(const std::string& key) const {
    const std::optional<std::string> value = yamlText(required(key));
    if (!value) {
      reject(key, "text");
    }
    return *value;
  }

  Eigen::VectorXd numbers(const std::string& key, Eigen::Index count) const {
    const std::optional<std::vector<double>> values = yamlNumbers(required(key));
    if (!values || static_cast<Eigen::Index>(values->size()) != count) {
      reject(key,
             "a list of " + std::to_string(count) + " numbers for " + text("camera_model") + "/" + text("distortion_model"));
    }
    return Eigen::Map<const Eigen::VectorXd>(values->data(), count);
  }

  void checkRange(const camera::CameraModel& kind, const Eigen::VectorXd& parameters) const {
    const Eigen::VectorXd lower = camera::lowerBound(kind);
    const Eigen::VectorXd upper = camera::upperBound(kind);
    for (Eigen::Index i = 0; i < parameters.size(); ++i) {
      if (parameters(i) < lower(i) || parameters(i) > upper(i)) {
        const bool is_intrinsic = i < camera::numIntrinsics(kind);
        const Eigen::Index position = is_intrinsic ? i : i - camera::numIntrinsics(kind);
        reject(is_intrinsic ? "intrinsics" : "distortion_coeffs",
               "number " + std::to_string(position + 1) + " from " + std::to_string(lower(i)) + " to " +
                   std::to_string(upper(i)) + " for " + camera::modelName(kind));
      }
    }
  }

  [[noreturn]] void reject(const std::string& key, const std::string& expected) const {
    throw InputError(yamlPlace(name_, map_[key]) + ": " + camera_ + ": invalid " + key + ": expected " + expected +
                     ", it is " + yamlExcerpt(map_[key]));
  }

  const YAML::Node map_;
  const std::string name_;
  const std::string camera_;
};

}  // namespace

Camchain parseCamchain(const std::string& text, const std::string& name, Extrinsics extrinsics) {
  const YAML::Node cameras = parseYamlMap(text, name);
  if (!cameras["cam0"].IsDefined()) {
    throw InputError(name + " is no camchain: it has no cam0");
  }
  Camchain chain;
  for (std::size_t index = 0; index < cameras.size(); ++index) {
    const std::string camera = cameraName(index);
    const YAML::Node node = cameras[camera];
    if (!node.IsDefined()) {
      throw InputError(name + ": expected " + std::to_string(cameras.size()) + " cameras named cam0, cam1, ...; " + camera +
                       " is missing");
    }
    const CameraReader reader(node, name, camera);
    calibration::RigCamera rig_camera{reader.camera(), geometry::Rigid3()};
    chain.has_extrinsics =
        chain.has_extrinsics && (index == 0 || extrinsics == Extrinsics::kRequired || reader.hasBaseline());
    if (index > 0 && chain.has_extrinsics) {
      rig_camera.T_cam_rig = reader.baseline() * chain.rig.cameras.back().T_cam_rig;
    }
    chain.rig.cameras.push_back(rig_camera);
    chain.topics.push_back(reader.topic());
    chain.overlaps.push_back(reader.overlaps());
  }
  return chain;
}

Camchain loadCamchain(const std::string& path, Extrinsics extrinsics) {
  return parseCamchain(readFile(path), path, extrinsics);
}

}  // namespace tartan_calib::io
