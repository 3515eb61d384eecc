#pragma once

#include <string>
#include <vector>

#include "support/simulated_scene.h"
#include "tartan_calib/calibration/camera_graph.h"
#include "tartan_calib/pipeline/calibrate.h"
#include "tartan_calib/report/analysis.h"
#include "tartan_calib/report/verdict.h"

namespace tartan_calib::report {

/// A 190-degree lens whose image circle fills the width of the image.
camera::Camera fisheye(int width = 640, int height = 480);

/// Solves a scene from its truth: what a calibration of it ends with, without the search for a start.
pipeline::CalibrationResult solved(const test_support::Scene& scene);

Analysis analysed(const pipeline::CalibrationResult& result);

}  // namespace tartan_calib::report
