#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/progress_bar.h"
#include "tartan_calib/calibration/rig.h"
#include "tartan_calib/calibration/validate.h"
#include "tartan_calib/pipeline/calibrate.h"

namespace tartan_calib::apps {

/// One camera against a recording that its calibration was not made from.
struct CameraValidation {
  std::string topic;
  camera::Camera camera;
  std::size_t num_images = 0;                    ///< looked at
  std::vector<calibration::ImageErrors> images;  ///< with the pose that all cameras share
  calibration::CameraErrors together;            ///< of these
  calibration::CameraErrors alone;               ///< with a pose of its own in each image
  std::optional<double> expected_px;             ///< rms that would be right
};

struct Validation {
  std::vector<CameraValidation> cameras;
  std::size_t num_views = 0;        ///< moments at which a camera saw the board
  std::size_t num_unexplained = 0;  ///< of these, without a pose
  std::size_t num_joint = 0;        ///< of these, seen by several cameras: they check extrinsics
};

/// Throws InputError where corners do not belong to the rig's cameras or the board, CalibrationError where no view can be
/// checked.
Validation validate(const calibration::Rig& rig, const target::Target& target,
                    const std::vector<pipeline::CameraCorners>& corners, std::int64_t approx_sync_ns,
                    const ProgressCall& progress);

/// Rms [px] that a calibration left itself, by camera, from the results file that Kalibr or calibrate_cameras wrote beside
/// the camchain. Empty where there is none that can be read and has so many cameras.
std::vector<double> residualsBeside(const std::string& camchain_file, std::size_t num_cameras);

enum class Fit { kHolds, kDoubtful, kFails, kUnknown };

struct Judgement {
  Fit fit = Fit::kUnknown;           ///< the worst of the cameras'
  std::vector<std::string> reasons;  ///< what is the matter, and what it may come from
};

Judgement judge(const Validation& validation);

/// For people: errors by camera and band, worst views, verdict.
std::string validationText(const Validation& validation);

/// One line per corner: camera, stamp_ns, corner_id, u_px, v_px, error_u_px, error_v_px, polar_deg, wrong.
std::string errorsCsv(const Validation& validation);

}  // namespace tartan_calib::apps
