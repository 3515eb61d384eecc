#pragma once

#include <vector>

#include "tartan_calib/pipeline/calibrate.h"

namespace tartan_calib::pipeline {

/// The images of a camera that have corners enough for a pose, all corners in play.
std::vector<observation::CameraView> imagesWithCorners(const CameraCorners& corners);

/// Corners gained and lost from one round to the next.
RoundSummary compareCorners(const std::vector<CameraCorners>& before, const std::vector<CameraCorners>& after);

/// Sets Corner::round of what a round saw: its own for corners that no round before it saw.
void keepRounds(const std::vector<CameraCorners>& before, int round, std::vector<CameraCorners>& after);

/// Adds what the solve after the round reached, and how far it moved the cameras' models from `before`.
void describeSolution(const calibration::Rig& before, const calibration::Solution& solution,
                      const std::vector<Eigen::Vector3d>& target_points, RoundSummary& summary);

/// True where another round would change next to nothing.
bool isSettled(const RoundSummary& summary);

}  // namespace tartan_calib::pipeline
