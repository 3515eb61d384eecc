#include "tartan_calib/calibration/initialize_camera.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <ostream>
#include <string>

#include "support/calibration_trial.h"
#include "support/simulated_scene.h"
#include "tartan_calib/error.h"

namespace tartan_calib::calibration {
namespace {

using test_support::Facing;
using test_support::Random;
using test_support::Scene;
using test_support::SceneOptions;

constexpr int kWidth = 1280;
constexpr int kHeight = 960;

struct Lens {
  const char* model_name;
  double fov_deg;
};

std::ostream& operator<<(std::ostream& stream, const Lens& lens) {
  return stream << lens.model_name << " of " << lens.fov_deg << " degrees";
}

double fovRad(const Lens& lens) { return lens.fov_deg * M_PI / 180.0; }

camera::Camera cameraOf(const Lens& lens) {
  Random random(7);
  return test_support::randomCamera(lens.model_name, fovRad(lens), kWidth, kHeight, random);
}

CameraSpec specOf(const Lens& lens) {
  CameraSpec spec;
  spec.model_name = lens.model_name;
  spec.width = kWidth;
  spec.height = kHeight;
  return spec;
}

Scene sceneOf(const Lens& lens, SceneOptions options) {
  options.max_polar_angle_rad = 0.5 * fovRad(lens);
  return test_support::simulateScene(cameraOf(lens), options);
}

Scene sceneOf(const Lens& lens, int num_views) {
  SceneOptions options;
  options.num_views = num_views;
  return sceneOf(lens, options);
}

CameraStart startOf(const CameraSpec& spec, const Scene& scene) {
  return initializeCamera(spec, scene.target_points, test_support::viewsOf(scene.views, 0));
}

double shareWithin(double limit_px, const CameraStart& start, const Scene& scene) {
  const auto views = test_support::viewsOf(scene.views, 0);
  return test_support::shareWithin(limit_px, test_support::withPoses(start.camera, scene, views), scene);
}

std::string errorOf(const CameraSpec& spec, const Scene& scene) {
  try {
    startOf(spec, scene);
  } catch (const CalibrationError& error) {
    return error.what();
  }
  return "";
}

class InitializeCamera : public ::testing::TestWithParam<Lens> {};

TEST_P(InitializeCamera, finds_the_lens_of_exact_corners) {
  const Scene scene = sceneOf(GetParam(), 15);
  const CameraStart start = startOf(specOf(GetParam()), scene);
  EXPECT_EQ(shareWithin(1e-3, start, scene), 1.0);
  EXPECT_TRUE(start.warnings.empty());
}

TEST_P(InitializeCamera, is_not_misled_by_views_parallel_to_the_image) {
  SceneOptions parallel;
  parallel.num_views = 10;
  parallel.max_tilt_rad = 0.0;
  parallel.facing = Facing::kImagePlane;
  Scene scene = sceneOf(GetParam(), parallel);
  const Scene tilted = sceneOf(GetParam(), 4);
  scene.views.insert(scene.views.end(), tilted.views.begin(), tilted.views.end());
  EXPECT_EQ(shareWithin(1e-2, startOf(specOf(GetParam()), scene), scene), 1.0);
}

INSTANTIATE_TEST_SUITE_P(Lenses, InitializeCamera,
                         ::testing::Values(Lens{"pinhole-none", 60}, Lens{"pinhole-radtan", 90}, Lens{"pinhole-equi", 260},
                                           Lens{"pinhole-fov", 200}, Lens{"omni-none", 220}, Lens{"omni-radtan", 150},
                                           Lens{"eucm-none", 190}, Lens{"ds-none", 220}));

const Lens kWide{"ds-none", 200};
const Lens kNarrow{"pinhole-none", 60};

TEST(InitializeCameraSpecial, gives_two_views_a_result_and_a_warning) {
  SceneOptions options;
  options.num_views = 2;
  options.min_corners = 60;
  options.max_corners = 60;
  const Scene scene = sceneOf(kWide, options);
  const CameraStart start = startOf(specOf(kWide), scene);
  EXPECT_EQ(shareWithin(0.5, start, scene), 1.0);
  ASSERT_EQ(start.warnings.size(), 1u);
  EXPECT_EQ(start.warnings[0].find("only 2 views with 120 corners: "), 0u) << start.warnings[0];
}

TEST(InitializeCameraSpecial, says_what_is_missing) {
  Scene scene = sceneOf(kWide, 3);
  scene.views[0].cameras[0].corners.resize(7);
  scene.views[1].cameras[0].corners.resize(7);
  const std::size_t num_corners = 14 + scene.views[2].cameras[0].corners.size();
  const std::string expected =
      "too few corners to start a camera: " + std::to_string(num_corners) +
      " corners in 3 views, 1 of them with at least 8; needed are 2 such views with the board at different angles";
  EXPECT_EQ(errorOf(specOf(kWide), scene), expected);
  EXPECT_NE(errorOf(specOf(kWide), Scene()), "");
}

TEST(InitializeCameraSpecial, refuses_corners_without_a_board) {
  Scene scene = sceneOf(kWide, 10);
  Random random(1);
  test_support::forEachCorner(scene.views, [&](observation::Corner& corner) {
    corner.px = {test_support::uniform(random, 0, kWidth), test_support::uniform(random, 0, kHeight)};
  });
  EXPECT_EQ(errorOf(specOf(kWide), scene).find("no ds-none lens explains the corners: "), 0u);
}

TEST(InitializeCameraSpecial, refuses_a_model_that_cannot_represent_the_lens) {
  CameraSpec spec = specOf(kWide);
  spec.model_name = "pinhole-none";
  EXPECT_EQ(errorOf(spec, sceneOf(kWide, 20)).find("no pinhole-none lens explains the corners: "), 0u);
}

TEST(InitializeCameraSpecial, warns_of_a_model_that_hardly_represents_the_lens) {
  const Lens lens{"ds-none", 90};
  CameraSpec spec = specOf(lens);
  spec.model_name = "pinhole-none";
  const CameraStart start = startOf(spec, sceneOf(lens, 20));
  ASSERT_EQ(start.warnings.size(), 1u);
  EXPECT_NE(start.warnings[0].find("pinhole-none may not fit this lens, which sees to 4"), std::string::npos)
      << start.warnings[0];
}

TEST(InitializeCameraSpecial, explains_views_that_leave_the_focal_length_open) {
  SceneOptions parallel;
  parallel.num_views = 10;
  parallel.max_tilt_rad = 0.0;
  parallel.facing = Facing::kImagePlane;
  const Scene scene = sceneOf(kNarrow, parallel);
  EXPECT_EQ(shareWithin(1.0, startOf(specOf(kNarrow), scene), scene), 1.0);
}

TEST(InitializeCameraSpecial, keeps_a_known_model_and_gives_poses) {
  const Scene scene = sceneOf(kWide, 5);
  CameraSpec spec = specOf(kWide);
  spec.known_model = cameraOf(kWide).model;
  const CameraStart start = startOf(spec, scene);
  EXPECT_EQ(camera::parameters(start.camera.model), camera::parameters(cameraOf(kWide).model));
  EXPECT_EQ(shareWithin(1e-3, start, scene), 1.0);
}

TEST(InitializeCameraSpecial, survives_any_focal_hint) {
  const Scene scene = sceneOf(kWide, 5);
  for (const double hint_px : {11.0, 350.0, 1e5}) {
    CameraSpec spec = specOf(kWide);
    spec.focal_hint_px = hint_px;
    EXPECT_EQ(shareWithin(1e-2, startOf(spec, scene), scene), 1.0) << "hint " << hint_px;
  }
}

TEST(InitializeCameraSpecial, has_the_same_bits_every_time) {
  const Scene scene = sceneOf(kWide, 6);
  const Eigen::VectorXd first = camera::parameters(startOf(specOf(kWide), scene).camera.model);
  EXPECT_EQ(first, camera::parameters(startOf(specOf(kWide), scene).camera.model));
}

}  // namespace
}  // namespace tartan_calib::calibration
