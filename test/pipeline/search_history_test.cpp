#include "../../src/pipeline/search_history.h"

#include <gtest/gtest.h>

#include "support/board_scene.h"
#include "tartan_calib/target/target.h"

namespace tartan_calib::pipeline {
namespace {

const std::vector<Eigen::Vector3d>& points() {
  static const std::vector<Eigen::Vector3d> points = target::cornerPoints(target::AprilGrid());
  return points;
}

camera::Camera lens() { return test_support::fisheyeCamera(1000, 800, 280.0); }

geometry::Rigid3 boardAhead() { return test_support::poseOf(target::AprilGrid(), {0.6, 0.2, 0.1, 0.1, 0.2, 0.3}); }

/// The board moved to its right, so that corners move by about `move_px`.
geometry::Rigid3 moved(double move_px) {
  geometry::Rigid3 T_cam_target = boardAhead();
  constexpr double kMetresPerPixel = 0.6 / 280.0;
  T_cam_target.translation.x() += move_px * kMetresPerPixel;
  return T_cam_target;
}

TEST(SearchHistoryTest, AnImageThatShowedAllCornersIsSearchedAgainOnceTheyMoveByHalfAPixel) {
  const SearchedImage before{lens(), boardAhead(), true};
  EXPECT_FALSE(hasMoved(before, lens(), moved(0.0), points()));
  EXPECT_FALSE(hasMoved(before, lens(), moved(0.3), points()));
  EXPECT_TRUE(hasMoved(before, lens(), moved(1.0), points()));
}

TEST(SearchHistoryTest, AnImageWhereSomeWereMissedIsSearchedAgainSooner) {
  const SearchedImage before{lens(), boardAhead(), false};
  EXPECT_FALSE(hasMoved(before, lens(), moved(0.03), points()));
  EXPECT_TRUE(hasMoved(before, lens(), moved(0.3), points()));
}

TEST(SearchHistoryTest, AnotherLensMovesThePredictionsToo) {
  const SearchedImage before{lens(), boardAhead(), true};
  EXPECT_TRUE(hasMoved(before, test_support::fisheyeCamera(1000, 800, 285.0), boardAhead(), points()));
}

TEST(SearchHistoryTest, CountsTheCornersWithinTheImage) {
  EXPECT_EQ(countPredicted(lens(), boardAhead(), points()), 144);
  const camera::Camera small = test_support::fisheyeCamera(300, 240, 280.0);
  EXPECT_LT(countPredicted(small, boardAhead(), points()), 144);
  EXPECT_GT(countPredicted(small, boardAhead(), points()), 0);
}

}  // namespace
}  // namespace tartan_calib::pipeline
