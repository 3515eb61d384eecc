#include "support/simulated_scene.h"

#include <gtest/gtest.h>

namespace tartan_calib {
namespace {

using test_support::Scene;
using test_support::SceneOptions;

struct Lens {
  const char* model_name;
  double fov_deg;
};

class SimulatedScene : public ::testing::TestWithParam<Lens> {};

TEST_P(SimulatedScene, shows_every_board_and_fills_the_field_of_view) {
  test_support::Random random(3);
  const double fov_rad = GetParam().fov_deg * M_PI / 180.0;
  const camera::Camera camera = test_support::randomCamera(GetParam().model_name, fov_rad, 1280, 960, random);
  SceneOptions options;
  options.max_polar_angle_rad = 0.5 * fov_rad;
  const Scene scene = test_support::simulateScene(camera, options);
  ASSERT_EQ(scene.views.size(), 40u);
  double largest_rad = 0.0;
  for (const observation::View& view : scene.views) {
    ASSERT_EQ(view.cameras.size(), 1u);
    EXPECT_GE(view.cameras[0].corners.size(), 16u);
    for (const observation::Corner& corner : view.cameras[0].corners) {
      largest_rad = std::max(largest_rad, std::acos(camera::unproject(camera.model, corner.px)->z()));
    }
  }
  EXPECT_LE(largest_rad, options.max_polar_angle_rad + 1e-9);
  EXPECT_GE(largest_rad, 0.9 * options.max_polar_angle_rad);
}

INSTANTIATE_TEST_SUITE_P(Lenses, SimulatedScene,
                         ::testing::Values(Lens{"pinhole-none", 60}, Lens{"pinhole-radtan", 90}, Lens{"pinhole-equi", 260},
                                           Lens{"pinhole-fov", 200}, Lens{"omni-none", 220}, Lens{"omni-radtan", 150},
                                           Lens{"eucm-none", 190}, Lens{"ds-none", 220}));

TEST(SimulatedSceneNoise, has_the_deviation_asked_for_and_leaves_the_scene_exact) {
  test_support::Random random(3);
  const Scene scene = test_support::simulateScene(test_support::randomCamera("ds-none", 3.0, 1280, 960, random), {});
  std::vector<observation::View> views = scene.views;
  test_support::addNoise(views, 0.3, 5);
  double sum_px2 = 0.0;
  int num_corners = 0;
  for (std::size_t v = 0; v < views.size(); ++v) {
    for (std::size_t c = 0; c < views[v].cameras[0].corners.size(); ++c) {
      sum_px2 += (views[v].cameras[0].corners[c].px - scene.views[v].cameras[0].corners[c].px).squaredNorm();
      ++num_corners;
    }
  }
  EXPECT_NEAR(std::sqrt(sum_px2 / (2 * num_corners)), 0.3, 0.02);
}

}  // namespace
}  // namespace tartan_calib
