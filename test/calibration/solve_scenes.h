#pragma once

#include <string>
#include <vector>

#include "support/simulated_scene.h"
#include "tartan_calib/calibration/solve.h"

/// Scenes and disturbed starts for the tests of the batch solve.
namespace tartan_calib::calibration {

using test_support::Random;
using test_support::Scene;
using test_support::SceneOptions;

inline constexpr double kNoise_px = 0.2;

geometry::Rigid3 randomMotion(Random& random, double sigma_m, double sigma_rad);

/// What each model can show, well inside its domain.
double usualFov(const std::string& model);

/// Cameras side by side, each turned a little against the one before.
Rig rowOfCameras(const std::vector<std::string>& models, Random& random);

Problem exactProblem(const Scene& scene);

Problem noisyProblem(const Scene& scene, double sigma_px, unsigned seed);

/// Moves all start values off the truth.
void disturbStart(Problem& problem, Random& random);

Eigen::VectorXd parametersOf(const Rig& rig, int camera_index);

geometry::Rigid3 baselineOf(const Rig& rig, int camera_index);

/// Estimate minus truth in the layout of Solution::covariance, without the board's warp.
Eigen::VectorXd errorVector(const Rig& estimate, const Rig& truth);

/// A suffix for the name of a parameterised test.
std::string testName(std::string model);

Scene sceneOf(const std::vector<std::string>& models, int num_views, unsigned seed = 7);

/// Estimate minus truth in units of the predicted stdev.
Eigen::ArrayXd normalisedErrors(const Solution& solution, const Rig& truth);

/// Noise alone exceeds this once in 1.7 million parameters.
inline constexpr double kMaxNormalisedError = 5.0;

}  // namespace tartan_calib::calibration
