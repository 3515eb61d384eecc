#include "solve_scenes.h"

namespace tartan_calib::calibration {

geometry::Rigid3 randomMotion(Random& random, double sigma_m, double sigma_rad) {
  geometry::Vector6d xi;
  for (int i = 0; i < 6; ++i) {
    xi(i) = test_support::normal(random, i < 3 ? sigma_m : sigma_rad);
  }
  return geometry::expRigid(xi);
}

double usualFov(const std::string& model) {
  return model == "pinhole-none" || model == "pinhole-radtan" ? 1.4 : model == "pinhole-fov" ? 2.6 : 3.2;
}

Rig rowOfCameras(const std::vector<std::string>& models, Random& random) {
  Rig rig;
  for (const std::string& model : models) {
    const double i = static_cast<double>(rig.cameras.size());
    geometry::Vector6d xi;
    xi << -0.1 * i, 0.01 * i, 0.005 * i, 0.02 * i, 0.1 * i, -0.03 * i;
    rig.cameras.push_back({test_support::randomCamera(model, usualFov(model), 1224, 1024, random), geometry::expRigid(xi)});
  }
  return rig;
}

Problem exactProblem(const Scene& scene) {
  return {scene.target_points, scene.views, scene.rig, scene.T_rig_target, Eigen::Vector2d::Zero()};
}

Problem noisyProblem(const Scene& scene, double sigma_px, unsigned seed) {
  Problem problem = exactProblem(scene);
  test_support::addNoise(problem.views, sigma_px, seed);
  return problem;
}

void disturbStart(Problem& problem, Random& random) {
  for (std::size_t i = 0; i < problem.rig.cameras.size(); ++i) {
    camera::CameraModel& model = problem.rig.cameras[i].camera.model;
    Eigen::VectorXd parameters = camera::parameters(model);
    const int focal = camera::focalIndex(model);
    parameters.segment<2>(focal) *= 1.02;
    parameters.segment<2>(focal + 2) += Eigen::Vector2d(4.0, -3.0);
    model = camera::withParameters(model, parameters);
    if (i > 0) {
      problem.rig.cameras[i].T_cam_rig = randomMotion(random, 0.005, 0.005) * problem.rig.cameras[i].T_cam_rig;
    }
  }
  for (geometry::Rigid3& T_rig_target : problem.T_rig_target) {
    T_rig_target = randomMotion(random, 0.01, 0.01) * T_rig_target;
  }
}

Eigen::VectorXd parametersOf(const Rig& rig, int camera_index) {
  return camera::parameters(rig.cameras[static_cast<std::size_t>(camera_index)].camera.model);
}

geometry::Rigid3 baselineOf(const Rig& rig, int camera_index) {
  const std::size_t i = static_cast<std::size_t>(camera_index);
  return rig.cameras[i].T_cam_rig * rig.cameras[i - 1].T_cam_rig.inverse();
}

Eigen::VectorXd errorVector(const Rig& estimate, const Rig& truth) {
  const int num_cameras = static_cast<int>(truth.cameras.size());
  Eigen::VectorXd error(intrinsicsRow(truth, num_cameras));
  for (int i = 0; i < num_cameras; ++i) {
    const Eigen::VectorXd parameters = parametersOf(truth, i);
    error.segment(intrinsicsRow(truth, i), parameters.size()) = parametersOf(estimate, i) - parameters;
    if (i > 0) {
      const geometry::Rigid3 found = baselineOf(estimate, i);
      const geometry::Rigid3 wanted = baselineOf(truth, i);
      error.segment<3>(baselineRow(i)) = geometry::logRotation(found.rotation * wanted.rotation.conjugate());
      error.segment<3>(baselineRow(i) + 3) = found.translation - wanted.translation;
    }
  }
  return error;
}

std::string testName(std::string model) {
  model[model.find('-')] = '_';
  return model;
}

Scene sceneOf(const std::vector<std::string>& models, int num_views, unsigned seed) {
  Random random(seed);
  SceneOptions options;
  options.num_views = num_views;
  options.seed = seed;
  return test_support::simulateScene(rowOfCameras(models, random), options);
}

Eigen::ArrayXd normalisedErrors(const Solution& solution, const Rig& truth) {
  const Eigen::VectorXd error = errorVector(solution.rig, truth);
  return error.array() / solution.covariance.diagonal().head(error.size()).array().sqrt();
}

}  // namespace tartan_calib::calibration
