#include "tartan_calib/camera/camera.h"

#include <array>
#include <type_traits>
#include <utility>

#include "tartan_calib/error.h"

namespace tartan_calib::camera {
namespace {

constexpr std::size_t kNumModels = std::variant_size_v<CameraModel>;

template <std::size_t... kIndex>
std::array<CameraModel, sizeof...(kIndex)> makeAll(std::index_sequence<kIndex...> /*indices*/) {
  return {
      CameraModel(std::in_place_index<kIndex>, std::variant_alternative_t<kIndex, CameraModel>::start(1.0, {0.0, 0.0}))...};
}

/// One of each kind, in the variant's order.
const std::array<CameraModel, kNumModels>& allModels() {
  static const std::array<CameraModel, kNumModels> models = makeAll(std::make_index_sequence<kNumModels>());
  return models;
}

template <typename Describe>
std::string listOf(const Describe& describe) {
  std::string list;
  for (const CameraModel& model : allModels()) {
    list += (list.empty() ? "" : ", ") + describe(model);
  }
  return list;
}

}  // namespace

std::vector<std::string> modelNames() {
  std::vector<std::string> names;
  for (const CameraModel& model : allModels()) {
    names.push_back(modelName(model));
  }
  return names;
}

CameraModel modelByName(const std::string& name) {
  for (const CameraModel& model : allModels()) {
    if (modelName(model) == name) {
      return model;
    }
  }
  throw InputError("Unknown camera model: " + name + ". Try [" + listOf(modelName) + "].");
}

CameraModel modelByKalibrNames(const std::string& camera_model, const std::string& distortion_model) {
  for (const CameraModel& model : allModels()) {
    if (kalibrModel(model) == camera_model && kalibrDistortion(model) == distortion_model) {
      return model;
    }
  }
  const std::string known =
      listOf([](const CameraModel& model) { return kalibrModel(model) + "/" + kalibrDistortion(model); });
  throw InputError("unknown camera_model/distortion_model '" + camera_model + "/" + distortion_model + "'; known are " +
                   known);
}

std::string modelName(const CameraModel& model) {
  return std::visit([](const auto& m) { return std::string(m.kName); }, model);
}

std::string kalibrModel(const CameraModel& model) {
  return std::visit([](const auto& m) { return std::string(m.kKalibrModel); }, model);
}

std::string kalibrDistortion(const CameraModel& model) {
  return std::visit([](const auto& m) { return std::string(m.kKalibrDistortion); }, model);
}

int numParameters(const CameraModel& model) {
  return std::visit([](const auto& m) { return m.kNumParameters; }, model);
}

int numIntrinsics(const CameraModel& model) {
  return std::visit([](const auto& m) { return m.kNumIntrinsics; }, model);
}

int focalIndex(const CameraModel& model) {
  return std::visit([](const auto& m) { return m.kFocalIndex; }, model);
}

Eigen::VectorXd parameters(const CameraModel& model) {
  return std::visit([](const auto& m) -> Eigen::VectorXd { return m.parameters(); }, model);
}

CameraModel withParameters(const CameraModel& model, const Eigen::VectorXd& parameters) {
  return std::visit(
      [&parameters](const auto& m) -> CameraModel {
        using Kind = std::decay_t<decltype(m)>;
        if (parameters.size() != Kind::kNumParameters) {
          throw Error(std::string(Kind::kName) + " takes " + std::to_string(Kind::kNumParameters) + " parameters, not " +
                      std::to_string(parameters.size()));
        }
        return Kind(typename Kind::Parameters(parameters));
      },
      model);
}

CameraModel startModel(const CameraModel& model, double focal_px, const Eigen::Vector2d& principal_point_px) {
  return std::visit(
      [&](const auto& m) -> CameraModel {
        using Kind = std::decay_t<decltype(m)>;
        return Kind(Kind::start(focal_px, principal_point_px));
      },
      model);
}

Eigen::VectorXd lowerBound(const CameraModel& model) {
  return std::visit([](const auto& m) -> Eigen::VectorXd { return m.lowerBound(); }, model);
}

Eigen::VectorXd upperBound(const CameraModel& model) {
  return std::visit([](const auto& m) -> Eigen::VectorXd { return m.upperBound(); }, model);
}

std::optional<Eigen::Vector2d> project(const CameraModel& model, const Eigen::Vector3d& p_cam, Matrix23d* J_px_pcam,
                                       ParameterJacobian* J_px_parameters) {
  const auto projected = [&](const auto& m) -> std::optional<Eigen::Vector2d> {
    Eigen::Vector2d px;
    if (J_px_parameters == nullptr) {
      return m.project(p_cam, px, J_px_pcam) ? std::make_optional(px) : std::nullopt;
    }
    typename std::decay_t<decltype(m)>::ParameterJacobian J;
    if (!m.project(p_cam, px, J_px_pcam, &J)) {
      return std::nullopt;
    }
    *J_px_parameters = J;
    return px;
  };
  return std::visit(projected, model);
}

std::optional<Eigen::Vector2d> project(const Camera& camera, const Eigen::Vector3d& p_cam, Matrix23d* J_px_pcam) {
  if (camera.pupil.isZero()) {
    return project(camera.model, p_cam, J_px_pcam);
  }
  Eigen::Matrix3d J_p;
  auto px = project(camera.model, camera.pupil.apply(p_cam, &J_p), J_px_pcam);
  if (px && J_px_pcam != nullptr) {
    *J_px_pcam *= J_p;
  }
  return px;
}

std::optional<Eigen::Vector3d> unproject(const CameraModel& model, const Eigen::Vector2d& px) {
  Eigen::Vector3d ray_cam;
  if (!std::visit([&](const auto& m) { return m.unproject(px, ray_cam); }, model)) {
    return std::nullopt;
  }
  return ray_cam;
}

bool isInside(const Camera& camera, const Eigen::Vector2d& px) {
  return px.x() >= -0.5 && px.y() >= -0.5 && px.x() < camera.width - 0.5 && px.y() < camera.height - 0.5;
}

}  // namespace tartan_calib::camera
