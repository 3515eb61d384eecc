#pragma once

#include <string>
#include <vector>

#include "tartan_calib/calibration/rig.h"
#include "tartan_calib/pipeline/calibrate.h"

namespace tartan_calib::io {

/// What Kalibr's camchain file holds.
struct Camchain {
  calibration::Rig rig;
  std::vector<std::string> topics;         ///< one per camera
  std::vector<std::vector<int>> overlaps;  ///< cameras with which a camera shares corners
  std::vector<std::string> comments;       ///< lines in front of the cameras, without '#'
  bool has_extrinsics = true;              ///< false: T_cam_rig of the rig means nothing
};

/// Whether a file may leave out T_cn_cnm1: all cameras' or some, none of which is read then.
enum class Extrinsics { kRequired, kOptional };

Camchain camchain(const pipeline::CalibrationResult& result);

/// In Kalibr's layout: PyYAML's sorted keys and shortest round-trip numbers.
std::string camchainText(const Camchain& chain);

/// Reads what Kalibr or camchainText wrote. Throws InputError that names file, camera and key. Keys of later tools
/// (T_cam_imu, ...) and a missing cam_overlaps or rostopic are accepted; comments are not kept.
Camchain loadCamchain(const std::string& path, Extrinsics extrinsics = Extrinsics::kRequired);

/// As loadCamchain; `name` stands for the file in messages.
Camchain parseCamchain(const std::string& text, const std::string& name, Extrinsics extrinsics = Extrinsics::kRequired);

}  // namespace tartan_calib::io
