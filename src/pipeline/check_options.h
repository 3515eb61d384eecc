#pragma once

#include "tartan_calib/calibration/initialize_camera.h"
#include "tartan_calib/pipeline/calibrate.h"

namespace tartan_calib::pipeline {

/// Throws InputError where the options contradict each other, or do not fit the target or the number of cameras.
void checkOptions(const CalibrateOptions& options, const target::Target& target, std::size_t num_cameras);

/// Throws InputError where the first images of a stream are not of the size that the known camera has. Detection takes
/// minutes; this does not.
void checkFirstImages(const std::vector<CameraStream>& streams, const calibration::Rig& known_rig);

/// Throws InputError where the corners do not belong to a target of that many corners, or are not in order.
void checkCorners(const CameraCorners& corners, int camera_index, int num_target_corners);

/// What camera `camera_index` is to be started from. Throws InputError where the known camera has images of another size.
calibration::CameraSpec cameraSpec(const CalibrateOptions& options, const CameraCorners& corners, int camera_index);

}  // namespace tartan_calib::pipeline
