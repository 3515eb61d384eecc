#include "solved_scene.h"

namespace tartan_calib::report {

camera::Camera fisheye(int width, int height) {
  Eigen::VectorXd parameters(6);
  parameters << -0.2, 0.59, 156.0, 156.0, 0.5 * (width - 1) + 1.7, 0.5 * (height - 1) - 2.4;
  return {camera::withParameters(camera::modelByName("ds-none"), parameters), width, height};
}

pipeline::CalibrationResult solved(const test_support::Scene& scene) {
  pipeline::CalibrationResult result;
  result.target = target::AprilGrid();
  result.solution = calibration::solve({scene.target_points, scene.views, scene.rig, scene.T_rig_target}, {});
  result.graph = calibration::cameraGraph(scene.views, static_cast<int>(scene.rig.cameras.size()));
  for (const auto& statistics : calibration::residualStatistics(result.solution, scene.target_points)) {
    pipeline::CameraReport camera;
    camera.topic = "/cam" + std::to_string(result.cameras.size()) + "/image_raw";
    camera.statistics = statistics;
    result.cameras.push_back(camera);
  }
  return result;
}

Analysis analysed(const pipeline::CalibrationResult& result) {
  return analyse(result, pipeline::CalibrateOptions(), seenCorners(result), {});
}

}  // namespace tartan_calib::report
