#include "tartan_calib/calibration/initialize_rig.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "support/simulated_scene.h"
#include "tartan_calib/calibration/solve.h"
#include "tartan_calib/error.h"

namespace tartan_calib::calibration {
namespace {

using geometry::Rigid3;
using observation::CameraView;
using observation::View;
using test_support::Random;
using test_support::Scene;
using test_support::SceneOptions;

Rigid3 lookingAt(double yaw_rad, const Eigen::Vector3d& centre_rig) {
  const Eigen::Quaterniond R_rig_cam(Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitY()));
  return Rigid3(R_rig_cam, centre_rig).inverse();
}

/// Cameras side by side, each turned by `step_rad` against its neighbour; models and resolutions differ.
Rig fan(int num_cameras, double step_rad) {
  const std::vector<std::string> models = {"ds-none", "pinhole-equi", "omni-none", "eucm-none"};
  Random random(4);
  Rig rig;
  for (int i = 0; i < num_cameras; ++i) {
    const int width = i % 2 == 0 ? 1280 : 752;
    const int height = i % 2 == 0 ? 960 : 480;
    const camera::Camera camera =
        test_support::randomCamera(models[static_cast<std::size_t>(i) % models.size()], 2.2, width, height, random);
    rig.cameras.push_back({camera, i == 0 ? Rigid3() : lookingAt(i * step_rad, {0.1 * i, 0.01 * i, -0.02 * i})});
  }
  return rig;
}

std::vector<camera::Camera> camerasOf(const Rig& rig) {
  std::vector<camera::Camera> cameras;
  for (const RigCamera& camera : rig.cameras) {
    cameras.push_back(camera.camera);
  }
  return cameras;
}

void removeCamera(View& view, int camera_index) {
  view.cameras.erase(std::remove_if(view.cameras.begin(), view.cameras.end(),
                                    [=](const CameraView& image) { return image.camera_index == camera_index; }),
                     view.cameras.end());
}

/// Well enough for a pose.
bool sees(const View& view, int camera_index) {
  return std::any_of(view.cameras.begin(), view.cameras.end(), [=](const CameraView& image) {
    return image.camera_index == camera_index && image.corners.size() >= 4;
  });
}

void expectRig(const Rig& rig, const Rig& truth, double tolerance_rad, double tolerance_m) {
  ASSERT_EQ(rig.cameras.size(), truth.cameras.size());
  for (std::size_t i = 0; i < rig.cameras.size(); ++i) {
    const Rigid3 error = rig.cameras[i].T_cam_rig * truth.cameras[i].T_cam_rig.inverse();
    EXPECT_LE(error.rotation.angularDistance(Eigen::Quaterniond::Identity()), tolerance_rad) << "cam" << i;
    EXPECT_LE(error.translation.norm(), tolerance_m) << "cam" << i;
  }
}

SceneOptions viewsPerCamera(int num_views, int num_cameras) {
  SceneOptions options;
  options.num_views = num_views * num_cameras;
  options.max_polar_angle_rad = 1.2;
  options.max_size_ratio = 0.7;
  return options;
}

class InitializeRig : public ::testing::TestWithParam<int> {};

TEST_P(InitializeRig, recovers_rig_and_poses_of_exact_corners) {
  const Rig rig = fan(GetParam(), 0.5);
  const Scene scene = test_support::simulateScene(rig, viewsPerCamera(8, GetParam()));
  const Problem problem = initializeRig(camerasOf(rig), scene.target_points, scene.views);
  expectRig(problem.rig, rig, 1e-6, 1e-6);
  ASSERT_EQ(problem.views.size(), scene.views.size());
  for (std::size_t v = 0; v < scene.views.size(); ++v) {
    const Rigid3 error = problem.T_rig_target[v] * scene.T_rig_target[v].inverse();
    EXPECT_LT(error.rotation.angularDistance(Eigen::Quaterniond::Identity()), 1e-6);
  }
}

INSTANTIATE_TEST_SUITE_P(NumCameras, InitializeRig, ::testing::Values(1, 2, 3, 8));

TEST(InitializeRigPair, reaches_cameras_that_never_see_the_board_together_through_a_third) {
  const Rig rig = fan(3, 0.7);
  Scene scene = test_support::simulateScene(rig, viewsPerCamera(40, 3));
  bool is_cam0_next = true;
  for (View& view : scene.views) {
    if (sees(view, 0) && sees(view, 2)) {
      removeCamera(view, is_cam0_next ? 0 : 2);
      is_cam0_next = !is_cam0_next;
    }
  }
  test_support::addNoise(scene.views, 0.2, 3);
  test_support::addWrongCorners(scene.views, 0.05, 30.0, 4);
  const Problem problem = initializeRig(camerasOf(rig), scene.target_points, scene.views);
  // Single-view poses at this distance scatter by a few millirad and millimetres.
  expectRig(problem.rig, rig, 5e-3, 5e-3);
  const Solution solution = solve(problem, SolveOptions());
  expectRig(solution.rig, rig, 2e-4, 3e-4);
}

TEST(InitializeRigPair, ignores_views_in_which_an_image_is_of_another_moment) {
  const Rig rig = fan(2, 0.2);
  Scene scene = test_support::simulateScene(rig, viewsPerCamera(15, 2));
  std::vector<std::size_t> shared;
  for (std::size_t v = 0; v < scene.views.size(); ++v) {
    if (scene.views[v].cameras.size() == 2) {
      shared.push_back(v);
    }
  }
  ASSERT_GE(shared.size(), 10u);
  // A third of the pairs gets the second image of another pair.
  for (std::size_t i = 0; i + 1 < shared.size(); i += 6) {
    std::swap(scene.views[shared[i]].cameras[1].corners, scene.views[shared[i + 1]].cameras[1].corners);
  }
  const Problem problem = initializeRig(camerasOf(rig), scene.target_points, scene.views);
  expectRig(problem.rig, rig, 1e-4, 1e-4);
}

TEST(InitializeRigPair, names_groups_and_shared_views_of_cameras_that_are_not_connected) {
  const Rig rig = fan(3, 0.2);
  Scene scene = test_support::simulateScene(rig, viewsPerCamera(5, 3));
  int num_shared = 0;
  for (std::size_t v = 0; v < scene.views.size(); ++v) {
    View& view = scene.views[v];
    if (v % 2 == 0) {
      removeCamera(view, 1);
    } else {
      removeCamera(view, 0);
      removeCamera(view, 2);
    }
    num_shared += sees(view, 0) && sees(view, 2) ? 1 : 0;
  }
  ASSERT_GT(num_shared, 0);
  try {
    initializeRig(camerasOf(rig), scene.target_points, scene.views);
    FAIL() << "no error";
  } catch (const CalibrationError& error) {
    const std::string message = error.what();
    EXPECT_NE(message.find("not connected through mutual observations: groups {cam0 cam2}, {cam1};"), std::string::npos)
        << message;
    EXPECT_NE(message.find("cam0-cam1 0, cam0-cam2 " + std::to_string(num_shared) + ", cam1-cam2 0;"), std::string::npos)
        << message;
  }
}

TEST(InitializeRigPair, keeps_a_known_rig_and_leaves_out_views_that_nothing_explains) {
  const Rig rig = fan(2, 0.2);
  Scene scene = test_support::simulateScene(rig, viewsPerCamera(4, 2));
  for (CameraView& image : scene.views[3].cameras) {
    image.corners.resize(3);
  }
  Rig known = rig;
  known.cameras[1].T_cam_rig.translation.x() += 0.01;
  const Problem problem = initializeRig(camerasOf(rig), scene.target_points, scene.views, {known, {}, 0});
  expectRig(problem.rig, known, 0.0, 1e-12);
  ASSERT_EQ(problem.views.size(), scene.views.size() - 1);
  EXPECT_EQ(problem.T_rig_target.size(), problem.views.size());
  EXPECT_EQ(problem.views[3].stamp_ns, scene.views[4].stamp_ns);
}

TEST(InitializeRigPair, takes_known_poses_and_estimates_the_others) {
  const Rig rig = fan(2, 0.2);
  const Scene scene = test_support::simulateScene(rig, viewsPerCamera(3, 2));
  RigStartOptions options;
  options.known_rig = rig;
  options.known_poses.resize(scene.views.size());
  const Rigid3 elsewhere(Eigen::Quaterniond::Identity(), Eigen::Vector3d(0.0, 0.0, 7.0));
  options.known_poses[1] = elsewhere;
  const Problem problem = initializeRig(camerasOf(rig), scene.target_points, scene.views, options);
  ASSERT_EQ(problem.T_rig_target.size(), scene.views.size());
  for (std::size_t v = 0; v < scene.views.size(); ++v) {
    const Rigid3& expected = v == 1 ? elsewhere : scene.T_rig_target[v];
    EXPECT_LT(geometry::logRigid(problem.T_rig_target[v] * expected.inverse()).norm(), 1e-6) << v;
  }
}

}  // namespace
}  // namespace tartan_calib::calibration
