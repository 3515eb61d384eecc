#include "tartan_calib/calibration/pose.h"

#include <gtest/gtest.h>

#include "support/simulated_scene.h"

namespace tartan_calib::calibration {
namespace {

using geometry::Rigid3;
using observation::Corner;
using test_support::Random;
using test_support::Scene;
using test_support::SceneOptions;

struct Lens {
  const char* model_name;
  double fov_deg;
};

double angleBetween(const Rigid3& a, const Rigid3& b) { return a.rotation.angularDistance(b.rotation); }

class EstimatePose : public ::testing::TestWithParam<Lens> {
 protected:
  Scene scene(const SceneOptions& base = {}) const {
    SceneOptions options = base;
    options.max_polar_angle_rad = 0.5 * fovRad();
    return test_support::simulateScene(camera(), options);
  }
  camera::Camera camera() const {
    Random random(7);
    return test_support::randomCamera(GetParam().model_name, fovRad(), 1280, 960, random);
  }
  static double fovRad() { return GetParam().fov_deg * M_PI / 180.0; }
};

TEST_P(EstimatePose, recovers_the_pose_of_exact_corners) {
  const Scene exact = scene();
  for (std::size_t v = 0; v < exact.views.size(); ++v) {
    const auto T = estimatePose(camera(), exact.target_points, exact.views[v].cameras[0].corners);
    ASSERT_TRUE(T.has_value()) << "view " << v;
    EXPECT_LT(angleBetween(*T, exact.T_rig_target[v]), 1e-6) << "view " << v;
    EXPECT_LT((T->translation - exact.T_rig_target[v].translation).norm(), 1e-6) << "view " << v;
  }
}

TEST_P(EstimatePose, ignores_wrong_corners) {
  SceneOptions options;
  options.num_views = 20;
  options.min_corners = 40;
  const Scene exact = scene(options);
  std::vector<observation::View> views = exact.views;
  test_support::addWrongCorners(views, 0.4, 30.0, 11);
  test_support::addNoise(views, 0.2, 12);
  for (std::size_t v = 0; v < views.size(); ++v) {
    const auto T = estimatePose(camera(), exact.target_points, views[v].cameras[0].corners);
    ASSERT_TRUE(T.has_value()) << "view " << v;
    std::vector<double> errors_px;
    for (const Corner& corner : exact.views[v].cameras[0].corners) {
      const auto px = camera::project(camera().model, *T * exact.target_points[static_cast<std::size_t>(corner.corner_id)]);
      errors_px.push_back((px.value() - corner.px).norm());
    }
    // A pose from 24 or more right corners of 0.2 px noise moves none of them by more than this.
    EXPECT_LT(*std::max_element(errors_px.begin(), errors_px.end()), 0.7) << "view " << v;
  }
}

INSTANTIATE_TEST_SUITE_P(Lenses, EstimatePose,
                         ::testing::Values(Lens{"pinhole-none", 60}, Lens{"pinhole-radtan", 100}, Lens{"pinhole-equi", 260},
                                           Lens{"omni-none", 220}, Lens{"eucm-none", 190}, Lens{"ds-none", 200}));

camera::Camera narrowCamera() {
  Eigen::VectorXd parameters(4);
  parameters << 800.0, 800.0, 640.0, 480.0;
  return {camera::withParameters(camera::modelByName("pinhole-none"), parameters), 1280, 960};
}

std::vector<Corner> imageOf(const Rigid3& T_cam_target, const std::vector<Eigen::Vector3d>& points, int num_corners) {
  std::vector<Corner> corners;
  for (int id = 0; id < num_corners; ++id) {
    corners.push_back(
        {id, camera::project(narrowCamera().model, T_cam_target * points[static_cast<std::size_t>(id)]).value()});
  }
  return corners;
}

const Rigid3 kFacing(Eigen::Quaterniond(Eigen::AngleAxisd(M_PI, Eigen::Vector3d::UnitX())), Eigen::Vector3d(-0.3, 0.3, 1.0));

TEST(EstimatePoseFew, needs_four_corners) {
  const std::vector<Eigen::Vector3d> square = {{0, 0, 0}, {0.1, 0, 0}, {0.1, 0.1, 0}, {0, 0.1, 0}};
  EXPECT_FALSE(estimatePose(narrowCamera(), square, {}).has_value());
  EXPECT_FALSE(estimatePose(narrowCamera(), square, imageOf(kFacing, square, 3)).has_value());
  const auto T = estimatePose(narrowCamera(), square, imageOf(kFacing, square, 4));
  ASSERT_TRUE(T.has_value());
  EXPECT_LT(angleBetween(*T, kFacing), 1e-6);
}

TEST(EstimatePoseFew, refuses_corners_on_a_line) {
  std::vector<Eigen::Vector3d> line;
  for (int i = 0; i < 8; ++i) {
    line.emplace_back(0.1 * i, 0.0, 0.0);
  }
  EXPECT_FALSE(estimatePose(narrowCamera(), line, imageOf(kFacing, line, 8)).has_value());
}

TEST(EstimatePoseFew, refuses_corners_that_no_pose_explains) {
  const std::vector<Eigen::Vector3d> points = target::cornerPoints(target::AprilGrid());
  Random random(5);
  std::vector<Corner> corners;
  for (int id = 0; id < 40; ++id) {
    corners.push_back({id, {test_support::uniform(random, 0, 1280), test_support::uniform(random, 0, 960)}});
  }
  EXPECT_FALSE(estimatePose(narrowCamera(), points, corners).has_value());
}

double sumOfSquares(const Rigid3& T_cam_target, const std::vector<Eigen::Vector3d>& points,
                    const std::vector<Corner>& corners) {
  double sum_px2 = 0.0;
  for (const Corner& corner : corners) {
    const Eigen::Vector3d& p_target = points[static_cast<std::size_t>(corner.corner_id)];
    sum_px2 += (camera::project(narrowCamera().model, T_cam_target * p_target).value() - corner.px).squaredNorm();
  }
  return sum_px2;
}

// A small tilted board looks nearly the same from a second pose, which is a local minimum of the error. Of the two the
// better one explains the corners at least as well as the truth does.
TEST(EstimatePoseFew, chooses_the_better_of_the_two_poses_of_a_small_board) {
  const std::vector<Eigen::Vector3d> square = {{0, 0, 0}, {0.1, 0, 0}, {0.1, 0.1, 0}, {0, 0.1, 0}, {0.05, 0.05, 0}};
  Random random(9);
  for (int i = 0; i < 200; ++i) {
    const double azimuth_rad = test_support::uniform(random, -M_PI, M_PI);
    const Eigen::Vector3d axis(std::cos(azimuth_rad), std::sin(azimuth_rad), 0.0);
    const Eigen::Quaterniond facing(Eigen::AngleAxisd(M_PI, Eigen::Vector3d::UnitX()));
    const Rigid3 truth(Eigen::AngleAxisd(test_support::uniform(random, 0.3, 0.9), axis) * facing,
                       Eigen::Vector3d(0.2, 0.1, 3.0));
    std::vector<Corner> corners = imageOf(truth, square, 5);
    for (Corner& corner : corners) {
      corner.px += Eigen::Vector2d(test_support::normal(random, 0.3), test_support::normal(random, 0.3));
    }
    const auto T = estimatePose(narrowCamera(), square, corners);
    ASSERT_TRUE(T.has_value());
    // The estimate minimises a robust loss, not the sum of squares itself.
    EXPECT_LT(sumOfSquares(*T, square, corners), 1.5 * sumOfSquares(truth, square, corners)) << "board " << i;
  }
}

}  // namespace
}  // namespace tartan_calib::calibration
