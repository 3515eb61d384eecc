#include "tartan_calib/calibration/initialize_camera.h"

#include <gtest/gtest.h>

#include <string>

#include "support/simulated_scene.h"
#include "tartan_calib/error.h"

namespace tartan_calib::calibration {
namespace {

using test_support::Random;
using test_support::Scene;
using test_support::SceneOptions;

constexpr int kWidth = 1280;
constexpr int kHeight = 960;

struct Lens {
  const char* model_name;
  double fov_deg;
};

double fovRad(const Lens& lens) { return lens.fov_deg * M_PI / 180.0; }

camera::Camera cameraOf(const Lens& lens) {
  Random random(7);
  return test_support::randomCamera(lens.model_name, fovRad(lens), kWidth, kHeight, random);
}

camera::Camera withCentreOffset(const camera::Camera& camera, const Eigen::Vector2d& offset_px) {
  Eigen::VectorXd parameters = camera::parameters(camera.model);
  parameters.segment<2>(camera::focalIndex(camera.model) + 2) += offset_px;
  return {camera::withParameters(camera.model, parameters), camera.width, camera.height};
}

CameraSpec specOf(const Lens& lens) {
  CameraSpec spec;
  spec.model_name = lens.model_name;
  spec.width = kWidth;
  spec.height = kHeight;
  return spec;
}

Scene sceneOf(const Lens& lens, const camera::Camera& camera, SceneOptions options = {}) {
  options.max_polar_angle_rad = 0.5 * fovRad(lens);
  return test_support::simulateScene(camera, options);
}

/// Share of all exact corners that the start puts within `limit_px`.
double shareWithin(double limit_px, const CameraStart& start, const Scene& scene) {
  const std::vector<observation::CameraView> views = test_support::viewsOf(scene.views, 0);
  double num_good = 0.0;
  double num_all = 0.0;
  for (std::size_t v = 0; v < views.size(); ++v) {
    for (const observation::Corner& corner : views[v].corners) {
      num_all += 1.0;
      const Eigen::Vector3d& p_target = scene.target_points[static_cast<std::size_t>(corner.corner_id)];
      const auto px =
          start.T_cam_target[v] ? camera::project(start.camera.model, *start.T_cam_target[v] * p_target) : std::nullopt;
      num_good += px && (*px - corner.px).norm() <= limit_px ? 1.0 : 0.0;
    }
  }
  return num_good / num_all;
}

/// The start from noisy corners, of which some are wrong.
CameraStart startFrom(const Lens& lens, const Scene& scene, double wrong_ratio) {
  std::vector<observation::View> views = scene.views;
  test_support::addNoise(views, 0.3, 21);
  test_support::addWrongCorners(views, wrong_ratio, 30.0, 22);
  return initializeCamera(specOf(lens), scene.target_points, test_support::viewsOf(views, 0));
}

class InitializeCamera : public ::testing::TestWithParam<Lens> {};

TEST_P(InitializeCamera, finds_the_lens_of_exact_corners) {
  const Scene scene = sceneOf(GetParam(), cameraOf(GetParam()));
  const CameraStart start = initializeCamera(specOf(GetParam()), scene.target_points, test_support::viewsOf(scene.views, 0));
  EXPECT_EQ(shareWithin(1e-3, start, scene), 1.0);
  EXPECT_TRUE(start.warnings.empty());
}

TEST_P(InitializeCamera, finds_the_lens_of_few_nearly_parallel_views_off_centre_with_wrong_corners) {
  SceneOptions options;
  options.num_views = 5;
  options.max_tilt_rad = 0.15;
  const camera::Camera camera = withCentreOffset(cameraOf(GetParam()), {0.08 * kWidth, -0.06 * kWidth});
  const Scene scene = sceneOf(GetParam(), camera, options);
  EXPECT_GE(shareWithin(1.5, startFrom(GetParam(), scene, 0.2), scene), 0.97);
}

INSTANTIATE_TEST_SUITE_P(Lenses, InitializeCamera,
                         ::testing::Values(Lens{"pinhole-none", 60}, Lens{"pinhole-radtan", 90}, Lens{"pinhole-equi", 260},
                                           Lens{"pinhole-fov", 200}, Lens{"omni-none", 220}, Lens{"omni-radtan", 150},
                                           Lens{"eucm-none", 190}, Lens{"ds-none", 220}));

}  // namespace
}  // namespace tartan_calib::calibration
