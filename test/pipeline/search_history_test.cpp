#include "../../src/pipeline/search_history.h"

#include <gtest/gtest.h>

#include "../../src/pipeline/bent_board.h"
#include "support/board_scene.h"
#include "tartan_calib/target/target.h"

namespace tartan_calib::pipeline {
namespace {

const std::vector<Eigen::Vector3d>& points() {
  static const std::vector<Eigen::Vector3d> points = target::cornerPoints(target::AprilGrid());
  return points;
}

camera::Camera lens(double focal_px = 280.0) { return test_support::fisheyeCamera(1000, 800, focal_px); }

geometry::Rigid3 boardAhead() { return test_support::poseOf(target::AprilGrid(), {0.6, 0.2, 0.1, 0.1, 0.2, 0.3}); }

detection::BoardMap mapBy(const camera::Camera& camera, const geometry::Rigid3& T_cam_target,
                          const Eigen::Vector2d& warp_m = Eigen::Vector2d::Zero()) {
  return boardMap(camera, T_cam_target, {calibration::BoardBend(points()), warp_m});
}

/// The board moved to its right, so that corners move by about `move_px`.
detection::BoardMap moved(double move_px) {
  geometry::Rigid3 T_cam_target = boardAhead();
  constexpr double kMetresPerPixel = 0.6 / 280.0;
  T_cam_target.translation.x() += move_px * kMetresPerPixel;
  return mapBy(lens(), T_cam_target);
}

TEST(SearchHistoryTest, AnImageThatShowedAllCornersIsSearchedAgainOnceTheyMoveByHalfAPixel) {
  const SearchedImage before{moved(0.0), true};
  EXPECT_FALSE(hasMoved(before, lens(), moved(0.0), points()));
  EXPECT_FALSE(hasMoved(before, lens(), moved(0.3), points()));
  EXPECT_TRUE(hasMoved(before, lens(), moved(1.0), points()));
}

TEST(SearchHistoryTest, AnImageWhereSomeWereMissedIsSearchedAgainSooner) {
  const SearchedImage before{moved(0.0), false};
  EXPECT_FALSE(hasMoved(before, lens(), moved(0.03), points()));
  EXPECT_TRUE(hasMoved(before, lens(), moved(0.3), points()));
}

TEST(SearchHistoryTest, AnotherLensMovesThePredictionsToo) {
  const SearchedImage before{mapBy(lens(), boardAhead()), true};
  const camera::Camera other = lens(285.0);
  EXPECT_TRUE(hasMoved(before, other, mapBy(other, boardAhead()), points()));
}

TEST(SearchHistoryTest, AnotherBendOfTheBoardMovesThePredictionsToo) {
  const SearchedImage before{mapBy(lens(), boardAhead(), {0.001, -0.002}), true};
  EXPECT_FALSE(hasMoved(before, lens(), mapBy(lens(), boardAhead(), {0.001, -0.002}), points()));
  EXPECT_TRUE(hasMoved(before, lens(), mapBy(lens(), boardAhead(), {0.006, -0.002}), points()));
}

TEST(SearchHistoryTest, ACornerThatHadNoImageIsLookedForOnceItHasOne) {
  const detection::BoardMap no_image = [](const Eigen::Vector2d&) { return std::optional<Eigen::Vector2d>(); };
  EXPECT_TRUE(hasMoved({no_image, true}, lens(), moved(0.0), points()));
  EXPECT_FALSE(hasMoved({moved(0.0), true}, lens(), no_image, points()));
  const auto beside = [](const Eigen::Vector2d&) { return std::make_optional<Eigen::Vector2d>(-50.0, 100.0); };
  EXPECT_FALSE(hasMoved({moved(0.0), true}, lens(), beside, points())) << "outside of the image nothing is found";
}

TEST(SearchHistoryTest, CountsTheCornersWithinTheImage) {
  EXPECT_EQ(countPredicted(lens(), mapBy(lens(), boardAhead()), points()), 144);
  const camera::Camera small = test_support::fisheyeCamera(300, 240, 280.0);
  EXPECT_LT(countPredicted(small, mapBy(small, boardAhead()), points()), 144);
  EXPECT_GT(countPredicted(small, mapBy(small, boardAhead()), points()), 0);
}

}  // namespace
}  // namespace tartan_calib::pipeline
