#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tartan_calib/pipeline/calibrate.h"

namespace tartan_calib::pipeline {

/// Says so where corners beyond 90 degrees took part in a model that Kalibr and OpenCV end at 90 degrees.
std::optional<std::string> hemisphereNote(const CalibrationResult& result, int camera_index);

/// What the images show in place of the target, where most say the same: a board of another size, mirrored tags, tags with
/// another border, two boards.
std::optional<std::string> boardNote(const CameraCorners& corners, const target::Target& target);

/// Says so where the pupil of the camera was fitted: the model alone then holds for far points.
std::optional<std::string> pupilNote(const CalibrationResult& result, int camera_index);

/// About images and tags of one camera: skipped images, dropped tags, a border of another width.
std::vector<std::string> detectionWarnings(const CameraCorners& corners, int camera_index, const target::Target& target);

/// What is doubtful about one camera of a finished calibration; empty where nothing is.
std::optional<std::string> fewViewsWarning(const CalibrationResult& result, int camera_index);
std::optional<std::string> largeResidualsWarning(const CalibrationResult& result, int camera_index);
std::optional<std::string> rejectedCornersWarning(const CalibrationResult& result, int camera_index);

/// What makes a solution doubtful by itself: a solve without end, parameters that the views do not determine.
std::vector<std::string> solutionWarnings(const calibration::Solution& solution);

/// About a finished calibration: too little data, doubtful or undetermined parameters, values that Kalibr would not write.
std::vector<std::string> resultWarnings(const CalibrationResult& result);

}  // namespace tartan_calib::pipeline
