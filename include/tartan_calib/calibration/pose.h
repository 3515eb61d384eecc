#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "tartan_calib/camera/camera.h"
#include "tartan_calib/geometry/rigid3.h"
#include "tartan_calib/observation/observation.h"

namespace tartan_calib::calibration {

/// Board pose T_cam_target from bearing vectors at any angle from the axis; robust against wrong corners. Empty below 4
/// usable corners or where no pose explains half of them.
std::optional<geometry::Rigid3> estimatePose(const camera::Camera& camera, const std::vector<Eigen::Vector3d>& target_points,
                                             const std::vector<observation::Corner>& corners);

/// The same for every image of a camera, on up to `num_threads` threads (0: all cores).
std::vector<std::optional<geometry::Rigid3>> estimatePoses(const camera::Camera& camera,
                                                           const std::vector<Eigen::Vector3d>& target_points,
                                                           const std::vector<observation::CameraView>& images,
                                                           int num_threads);

}  // namespace tartan_calib::calibration
