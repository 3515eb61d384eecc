#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "tartan_calib/camera/double_sphere.h"
#include "tartan_calib/camera/equidistant.h"
#include "tartan_calib/camera/eucm.h"
#include "tartan_calib/camera/fov.h"
#include "tartan_calib/camera/omni.h"
#include "tartan_calib/camera/pinhole.h"
#include "tartan_calib/camera/pupil_shift.h"

namespace tartan_calib::camera {

/// Every lens model. A new one is added here and nowhere else outside of its own header and its test line.
using CameraModel =
    std::variant<PinholeNone, PinholeRadtan, PinholeEqui, PinholeFov, OmniNone, OmniRadtan, Eucm, DoubleSphere>;

/// A lens model with its parameters, and the size of the images it belongs to. The pupil stays in place unless a solve was
/// asked to move it; files of camchains do not know it. Functions below look the model up for every
/// call, which costs little beside a projection.
struct Camera {
  CameraModel model;
  int width = 0;
  int height = 0;
  PupilShift pupil = {};
};

/// Names on the command line (`ds-none`), in the variant's order.
std::vector<std::string> modelNames();

/// A model with its default start parameters. Throws InputError that lists the known names.
CameraModel modelByName(const std::string& name);

/// A model by the two names in a camchain file (`pinhole`, `equidistant`). Throws InputError that lists the known pairs.
CameraModel modelByKalibrNames(const std::string& camera_model, const std::string& distortion_model);

std::string modelName(const CameraModel& model);
std::string kalibrModel(const CameraModel& model);
std::string kalibrDistortion(const CameraModel& model);

int numParameters(const CameraModel& model);
int numIntrinsics(const CameraModel& model);  ///< the rest are distortion coefficients
int focalIndex(const CameraModel& model);     ///< of fu in the parameters; fv, cu, cv follow

/// All parameters in Kalibr's order: intrinsics, then distortion coefficients.
Eigen::VectorXd parameters(const CameraModel& model);

/// The same kind of model with other parameters. Throws Error where the count is wrong.
CameraModel withParameters(const CameraModel& model, const Eigen::VectorXd& parameters);

/// As Model::start.
CameraModel startModel(const CameraModel& model, double focal_px, const Eigen::Vector2d& principal_point_px);

Eigen::VectorXd lowerBound(const CameraModel& model);
Eigen::VectorXd upperBound(const CameraModel& model);

/// d(pixel) / d(parameters of some model).
using ParameterJacobian = Eigen::Matrix<double, 2, Eigen::Dynamic>;

/// Pixel of a point in the camera frame; empty where the model gives it no image. May lie outside of the image.
std::optional<Eigen::Vector2d> project(const CameraModel& model, const Eigen::Vector3d& p_cam,
                                       Matrix23d* J_px_pcam = nullptr, ParameterJacobian* J_px_parameters = nullptr);

/// The same through the camera's moving pupil, for points at a finite distance [m].
std::optional<Eigen::Vector2d> project(const Camera& camera, const Eigen::Vector3d& p_cam, Matrix23d* J_px_pcam = nullptr);

/// Unit ray of a pixel in the camera frame; empty where the model has none.
std::optional<Eigen::Vector3d> unproject(const CameraModel& model, const Eigen::Vector2d& px);

/// True for -0.5 <= u < width - 0.5 and the same for v.
bool isInside(const Camera& camera, const Eigen::Vector2d& px);

}  // namespace tartan_calib::camera
