#include "moving_scene.h"

namespace tartan_calib::report {

test_support::Scene movingScene(double delay_ms) {
  constexpr int kViews = 80;
  constexpr double kPeriodMs = 50.0;
  constexpr double kNoise_px = 0.05;
  test_support::Scene scene;
  scene.target_points = target::cornerPoints(target::AprilGrid());
  scene.rig.cameras = {{fisheye(), geometry::Rigid3()},
                       {fisheye(), geometry::Rigid3(Eigen::Quaterniond::Identity(), Eigen::Vector3d(-0.12, 0.0, 0.01))}};
  const Eigen::Vector3d centre = 0.5 * (scene.target_points.front() + scene.target_points.back());
  const auto pose = [&](double time_ms) {
    const double t = time_ms * 1e-3;
    const Eigen::Quaterniond facing(Eigen::AngleAxisd(0.5 * std::sin(3.1 * t), Eigen::Vector3d::UnitY()) *
                                    Eigen::AngleAxisd(M_PI + 0.5 * std::cos(2.3 * t), Eigen::Vector3d::UnitX()) *
                                    Eigen::AngleAxisd(0.8 * std::sin(1.7 * t), Eigen::Vector3d::UnitZ()));
    const Eigen::Vector3d place(0.45 * std::sin(2.6 * t), 0.35 * std::cos(3.3 * t), 0.65 + 0.2 * std::sin(1.9 * t));
    return geometry::Rigid3(facing, place - facing * centre);
  };
  for (int i = 0; i < kViews; ++i) {
    observation::View view;
    view.stamp_ns = static_cast<std::int64_t>((i + 1) * kPeriodMs * 1e6);
    for (int camera = 0; camera < 2; ++camera) {
      const calibration::RigCamera& rig_camera = scene.rig.cameras[static_cast<std::size_t>(camera)];
      const double time_ms = i * kPeriodMs + camera * delay_ms;
      view.cameras.push_back(
          test_support::visibleCorners(rig_camera.camera, scene.target_points, rig_camera.T_cam_rig * pose(time_ms), M_PI));
      view.cameras.back().camera_index = camera;
      view.cameras.back().stamp_ns = view.stamp_ns;
    }
    scene.views.push_back(view);
    scene.T_rig_target.push_back(pose(i * kPeriodMs));
  }
  test_support::addNoise(scene.views, kNoise_px, 1);
  return scene;
}

}  // namespace tartan_calib::report
