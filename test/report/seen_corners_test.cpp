#include "tartan_calib/report/seen_corners.h"

#include <gtest/gtest.h>

#include "solved_scene.h"

namespace tartan_calib::report {
namespace {

test_support::Scene scene() {
  test_support::SceneOptions options;
  options.num_views = 12;
  return test_support::simulateScene(fisheye(), options);
}

TEST(SeenCornersTest, EveryCornerInTheImageIsEitherFoundOrMissed) {
  test_support::Scene with_gaps = scene();
  std::size_t num_all = 0;
  std::size_t num_dropped = 0;
  for (observation::View& view : with_gaps.views) {
    std::vector<observation::Corner>& corners = view.cameras.front().corners;
    num_all += corners.size();
    num_dropped += 3;
    corners.erase(corners.begin() + 1, corners.begin() + 4);
  }
  const SeenCorners seen = seenCorners(solved(with_gaps)).front();
  EXPECT_EQ(seen.missed.size(), num_dropped);
  EXPECT_EQ(seen.found.size(), num_all - num_dropped);
}

TEST(SeenCornersTest, MissedCornersAreWhereTheBoardIs) {
  test_support::Scene with_gap = scene();
  std::vector<observation::Corner>& corners = with_gap.views[4].cameras.front().corners;
  const observation::Corner dropped = corners[5];
  corners.erase(corners.begin() + 5);
  const SeenCorners seen = seenCorners(solved(with_gap)).front();
  ASSERT_EQ(seen.missed.size(), 1U);
  EXPECT_EQ(seen.missed[0].view, 4);
  EXPECT_EQ(seen.missed[0].corner_id, dropped.corner_id);
  EXPECT_LT((seen.missed[0].px - dropped.px).norm(), 1e-3);
  EXPECT_NEAR(seen.missed[0].polar_rad, *polarAngle(with_gap.rig.cameras[0].camera.model, dropped.px), 1e-5);
}

TEST(SeenCornersTest, ResidualsAreMeasuredMinusPredicted) {
  pipeline::CalibrationResult result = solved(scene());
  result.solution.views[0].cameras[0].corners[0].px += Eigen::Vector2d(0.5, -0.25);
  const SeenCorners seen = seenCorners(result).front();
  EXPECT_NEAR(seen.found[0].residual_px->x(), 0.5, 1e-3);
  EXPECT_NEAR(seen.found[0].residual_px->y(), -0.25, 1e-3);
}

}  // namespace
}  // namespace tartan_calib::report
