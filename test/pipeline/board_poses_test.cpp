#include "../../src/pipeline/board_poses.h"

#include <gtest/gtest.h>

namespace tartan_calib::pipeline {
namespace {

constexpr std::int64_t kMillisecond_ns = 1'000'000;
constexpr std::int64_t kSync_ns = 20 * kMillisecond_ns;

geometry::Rigid3 poseAt(double x_m, double turn_rad) {
  return {geometry::expRotation({0.0, 0.0, turn_rad}), Eigen::Vector3d(x_m, 0.0, 1.0)};
}

/// Two cameras; views at 1000, 1100, 1200 and 2000 ms, the third without a solved corner; cam1 took part in the first.
calibration::Solution solution() {
  calibration::Solution solution;
  solution.rig.cameras.resize(2);
  solution.rig.cameras[1].T_cam_rig = geometry::Rigid3(Eigen::Quaterniond::Identity(), Eigen::Vector3d(-0.1, 0.0, 0.0));
  for (const std::int64_t stamp_ms : {1000, 1100, 1200, 2000}) {
    observation::View view;
    view.stamp_ns = stamp_ms * kMillisecond_ns;
    view.cameras = {{0, view.stamp_ns, {}}};
    solution.views.push_back(view);
  }
  solution.views[0].cameras.push_back({1, 1005 * kMillisecond_ns, {}});
  solution.T_rig_target = {poseAt(0.0, 0.0), poseAt(0.2, 0.4), poseAt(9.0, 9.0), poseAt(0.5, 0.5)};
  solution.unsolved_views = {2};
  return solution;
}

void expectPose(const std::optional<geometry::Rigid3>& pose, const geometry::Rigid3& expected) {
  ASSERT_TRUE(pose.has_value());
  EXPECT_TRUE(pose->matrix().isApprox(expected.matrix(), 1e-12)) << pose->matrix();
}

TEST(BoardPosesTest, AnImageOfASolvedViewHasThatViewsPoseInItsOwnCamera) {
  const calibration::Solution solved = solution();
  const BoardPoses poses(solved, kSync_ns);
  expectPose(poses.solved(0, 1100 * kMillisecond_ns), poseAt(0.2, 0.4));
  expectPose(poses.solved(1, 1005 * kMillisecond_ns), poseAt(-0.1, 0.0));
  EXPECT_FALSE(poses.solved(1, 1100 * kMillisecond_ns)) << "cam1 was not in that view";
  EXPECT_FALSE(poses.solved(0, 1200 * kMillisecond_ns)) << "the view was not solved";
}

/// A view of both cameras at 1000 ms, with so many corners in each.
observation::View firstView(std::size_t num_corners, bool is_used = false) {
  observation::View view;
  view.stamp_ns = 1000 * kMillisecond_ns;
  std::vector<observation::Corner> corners(num_corners);
  for (observation::Corner& corner : corners) {
    corner.used = is_used;
  }
  view.cameras = {{0, view.stamp_ns, corners}, {1, 1005 * kMillisecond_ns, corners}};
  return view;
}

TEST(BoardPosesTest, AViewIsExplainedWhereHalfOfItsCornersWereUsed) {
  calibration::Solution solved = solution();
  solved.views[0] = firstView(10, true);
  const BoardPoses poses(solved, kSync_ns);
  expectPose(poses.explained(firstView(20)), poseAt(0.0, 0.0));
  EXPECT_FALSE(poses.explained(firstView(21))) << "of 42 corners 20 were used";
  observation::View other = firstView(10);
  other.cameras[0].stamp_ns = 1100 * kMillisecond_ns;
  EXPECT_FALSE(poses.explained(other)) << "its images were in different views";
  solved.views[0] = firstView(0, true);
  EXPECT_FALSE(BoardPoses(solved, kSync_ns).explained(firstView(0))) << "nothing was used";
}

TEST(BoardPosesTest, AnotherCameraOfTheSameTimeTellsThePose) {
  const calibration::Solution solved = solution();
  const BoardPoses poses(solved, kSync_ns);
  expectPose(poses.guessed(1, 1115 * kMillisecond_ns), poseAt(0.1, 0.4));
}

TEST(BoardPosesTest, BetweenTwoViewsThePoseIsInterpolated) {
  const calibration::Solution solved = solution();
  const BoardPoses poses(solved, kSync_ns);
  expectPose(poses.guessed(0, 1050 * kMillisecond_ns), poseAt(0.1, 0.2));
  expectPose(poses.guessed(0, 1025 * kMillisecond_ns), poseAt(0.05, 0.1));
}

TEST(BoardPosesTest, NothingIsGuessedOverALongGapOrBeyondTheEnds) {
  const calibration::Solution solved = solution();
  const BoardPoses poses(solved, kSync_ns);
  EXPECT_FALSE(poses.guessed(0, 1500 * kMillisecond_ns));
  EXPECT_FALSE(poses.guessed(0, 900 * kMillisecond_ns));
  EXPECT_FALSE(poses.guessed(0, 2100 * kMillisecond_ns));
  expectPose(poses.guessed(0, 2010 * kMillisecond_ns), poseAt(0.5, 0.5));
}

}  // namespace
}  // namespace tartan_calib::pipeline
