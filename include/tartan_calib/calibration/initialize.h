#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "tartan_calib/calibration/rig.h"
#include "tartan_calib/calibration/solve.h"
#include "tartan_calib/camera/camera.h"
#include "tartan_calib/geometry/rigid3.h"
#include "tartan_calib/observation/observation.h"

namespace tartan_calib::calibration {

/// A camera to be started: the model that the user asked for and the images it took.
struct CameraSpec {
  std::string model_name;  ///< ds-none
  int width = 0;
  int height = 0;
  std::optional<double> focal_hint_px;             ///< of the image centre, from KALIBR_MANUAL_FOCAL_LENGTH_INIT
  std::optional<camera::CameraModel> known_model;  ///< from --init: only poses are started
};

/// A single camera with its own board poses; poses are absent where a view could not be explained.
struct CameraStart {
  camera::Camera camera;
  std::vector<std::optional<geometry::Rigid3>> T_cam_target;  ///< one per CameraView
};

/// Intrinsics and poses of one camera from nothing but corners (any central lens of 60-260 degrees): radial 1D constraint,
/// division model, target model by regression, robust bundle adjustment. Deterministic. Throws CalibrationError that says
/// how many corners and views there were and how many are needed.
CameraStart initializeCamera(const CameraSpec& spec, const std::vector<Eigen::Vector3d>& target_points,
                             const std::vector<observation::CameraView>& views);

/// Board pose from bearing vectors at any angle from the axis; robust against wrong corners. Empty below 4 usable corners or
/// where no pose explains half of them.
std::optional<geometry::Rigid3> estimatePose(const camera::Camera& camera, const std::vector<Eigen::Vector3d>& target_points,
                                             const std::vector<observation::Corner>& corners);

/// How the cameras are connected: views that two cameras share, and corners seen by both in those views.
struct CameraGraph {
  Eigen::MatrixXi shared_views;  ///< symmetric, num_cameras x num_cameras
  Eigen::MatrixXi shared_corners;
  std::vector<std::vector<int>> groups;  ///< connected components over shared corners, by first camera
};

CameraGraph cameraGraph(const std::vector<observation::View>& views, int num_cameras);

/// Joins single images to views: each stamp goes to the nearest view within tolerance, at most one image of a camera per
/// view. `cameras[i]`: the views of camera i by increasing stamp. Views are returned by increasing stamp.
std::vector<observation::View> synchronize(const std::vector<std::vector<observation::CameraView>>& cameras,
                                           std::int64_t tolerance_ns);

/// Start for the joint solve: intrinsics camera by camera, extrinsics along the best-connected tree, a pose per view. Views
/// that nothing explains are left out. Throws CalibrationError with the groups and the shared views per pair where cameras
/// are not connected. `known_rig`: extrinsics from --init.
Problem initializeRig(const std::vector<CameraSpec>& cameras, const std::vector<Eigen::Vector3d>& target_points,
                      const std::vector<observation::View>& views, const std::optional<Rig>& known_rig = std::nullopt);

}  // namespace tartan_calib::calibration
