#include "../../src/pipeline/bent_board.h"

#include <gtest/gtest.h>

#include "support/board_scene.h"
#include "tartan_calib/calibration/solve.h"
#include "tartan_calib/target/target.h"

namespace tartan_calib::pipeline {
namespace {

TEST(BentBoardTest, PredictsTheCornersOfTheBoardThatTheSolverBends) {
  const std::vector<Eigen::Vector3d> flat = target::cornerPoints(target::AprilGrid());
  const Eigen::Vector2d warp_m(0.004, -0.002);
  const std::vector<Eigen::Vector3d> bent = calibration::warpedPoints(flat, warp_m);
  const camera::Camera camera = test_support::fisheyeCamera(1000, 800, 280.0);
  const geometry::Rigid3 T_cam_target = test_support::poseOf(target::AprilGrid(), {0.5, 0.9, 0.1, 0.1, 0.2, 0.3});
  const detection::BoardMap map = boardMap(camera, T_cam_target, {calibration::BoardBend(flat), warp_m});
  double largest_px = 0.0;
  for (std::size_t i = 0; i < flat.size(); ++i) {
    const auto expected = camera::project(camera.model, T_cam_target * bent[i]);
    const auto predicted = map(flat[i].head<2>());
    ASSERT_EQ(predicted.has_value(), expected.has_value());
    EXPECT_LT((*predicted - *expected).norm(), 1e-9);
    largest_px = std::max(largest_px, (*expected - *camera::project(camera.model, T_cam_target * flat[i])).norm());
  }
  EXPECT_GT(largest_px, 0.5) << "the bend must matter";
}

}  // namespace
}  // namespace tartan_calib::pipeline
