#include "tartan_calib/detection/corner_recovery.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <opencv2/imgproc.hpp>

#include "recovery_score.h"
#include "support/board_scene.h"
#include "tartan_calib/error.h"

namespace tartan_calib::detection {
namespace {

using test_support::BoardPose;
using test_support::BoardScene;
using test_support::kDegree;

/// A 200-degree fisheye with the board far from the axis: its image reaches the rim.
const BoardPose kAtTheRim{0.55, 75.0 * kDegree, 0.4, 10.0 * kDegree, -15.0 * kDegree, 20.0 * kDegree};

camera::Camera fisheye() { return test_support::fisheyeCamera(1000, 1000, 280.0); }

TEST(CornerRecoveryTest, FindsTheCornersThatAPosedModelPredicts) {
  const target::AprilGrid grid;
  BoardScene scene(fisheye());
  const auto truth = scene.add(grid, kAtTheRim);
  const BoardMap map = flatBoardMap(scene.camera(), test_support::poseOf(grid, kAtTheRim));
  const RecoveryScore result = recoveryScore(CornerRecovery(grid).recover(scene.expose(0.7, 2.0), map), truth);
  EXPECT_GE(result.found, 0.98 * result.expected) << "of " << result.expected;
  EXPECT_GT(result.expected, 100);
  EXPECT_EQ(result.wrong, 0);
  EXPECT_LT(result.median_px, 0.04);
}

TEST(CornerRecoveryTest, ToleratesPredictionsThatAreSeveralPixelsOff) {
  const target::AprilGrid grid;
  BoardScene scene(fisheye());
  const auto truth = scene.add(grid, kAtTheRim);
  const BoardMap exact = flatBoardMap(scene.camera(), test_support::poseOf(grid, kAtTheRim));
  // An error that grows over the image, as that of a model that extrapolates.
  const BoardMap map = [&exact](const Eigen::Vector2d& p_m) -> std::optional<Eigen::Vector2d> {
    const auto px = exact(p_m);
    return px ? std::optional<Eigen::Vector2d>(*px + Eigen::Vector2d(1.5 + 2.0 * p_m.x(), -1.0 - 2.5 * p_m.y())) : px;
  };
  const RecoveryScore result = recoveryScore(CornerRecovery(grid).recover(scene.expose(0.7, 2.0), map), truth);
  EXPECT_GE(result.found, 0.95 * result.expected) << "of " << result.expected;
  EXPECT_EQ(result.wrong, 0);
}

TEST(CornerRecoveryTest, ReportsNoCoveredCorner) {
  const target::AprilGrid grid;
  BoardScene scene(fisheye());
  const auto truth = scene.add(grid, {0.5, 30.0 * kDegree, 0.4, 10.0 * kDegree, -15.0 * kDegree, 20.0 * kDegree});
  const BoardMap map =
      flatBoardMap(scene.camera(),
                   test_support::poseOf(grid, {0.5, 30.0 * kDegree, 0.4, 10.0 * kDegree, -15.0 * kDegree, 20.0 * kDegree}));
  const Eigen::Vector2d middle_px = truth[truth.size() / 2].px;
  constexpr int kRadius_px = 60;
  cv::circle(scene.grey(), cv::Point(static_cast<int>(middle_px.x()), static_cast<int>(middle_px.y())), kRadius_px, 150.0F,
             cv::FILLED);
  std::vector<observation::Corner> corners = CornerRecovery(grid).recover(scene.expose(0.7, 2.0), map);
  int covered = 0;
  for (const observation::Corner& corner : corners) {
    covered += (corner.px - middle_px).norm() < kRadius_px ? 1 : 0;
  }
  EXPECT_EQ(covered, 0);
  const RecoveryScore result = recoveryScore(corners, truth);
  EXPECT_EQ(result.wrong, 0);
  int clear = 0;
  for (const simulation::TrueCorner& corner : truth) {
    const bool is_clear = (corner.px - middle_px).norm() > kRadius_px + 6.0;
    clear += is_clear && corner.visible && corner.neighbour_distance_px >= 4.0 ? 1 : 0;
  }
  EXPECT_GE(result.found, 0.97 * clear) << "of " << clear;
}

TEST(CornerRecoveryTest, ReportsNoCornerJustBehindTheEdgeOfAHandFromAnySide) {
  const target::AprilGrid grid;
  const BoardPose pose{0.5, 30.0 * kDegree, 0.4, 10.0 * kDegree, -15.0 * kDegree, 20.0 * kDegree};
  const BoardMap map = flatBoardMap(fisheye(), test_support::poseOf(grid, pose));
  constexpr double kRadius_px = 40.0;
  constexpr double kDepth_px = 2.0;
  constexpr double kClear_px = 6.0;
  constexpr int kDirections = 12;
  int clear = 0;
  int found = 0;
  for (int k = 0; k < kDirections; ++k) {
    BoardScene scene(fisheye());
    const auto truth = scene.add(grid, pose);
    const simulation::TrueCorner& covered = truth[truth.size() / 3 + static_cast<std::size_t>(k)];
    const double angle_rad = 30.0 * kDegree * k;
    const Eigen::Vector2d hand_px =
        covered.px + (kRadius_px - kDepth_px) * Eigen::Vector2d(std::cos(angle_rad), std::sin(angle_rad));
    constexpr int kShift = 4;  // fractional bits of OpenCV's drawing
    const Eigen::Vector2d fixed = hand_px * (1 << kShift);
    cv::circle(scene.grey(), cv::Point(static_cast<int>(std::lround(fixed.x())), static_cast<int>(std::lround(fixed.y()))),
               static_cast<int>(kRadius_px) << kShift, 110.0F, cv::FILLED, cv::LINE_8, kShift);
    const auto corners = CornerRecovery(grid).recover(scene.expose(0.7, 2.0), map);
    const RecoveryScore result = recoveryScore(corners, truth);
    EXPECT_EQ(result.wrong, 0);
    found += result.found;
    for (const observation::Corner& corner : corners) {
      EXPECT_GT((truth[static_cast<std::size_t>(corner.corner_id)].px - hand_px).norm(), kRadius_px - kDepth_px)
          << "corner " << corner.corner_id << ", hand from " << angle_rad / kDegree << " degrees";
    }
    for (const simulation::TrueCorner& corner : truth) {
      clear += (corner.px - hand_px).norm() > kRadius_px + kClear_px ? 1 : 0;
    }
  }
  EXPECT_GE(found, 0.98 * clear) << "of " << clear;
}

/// Counts the corners that `is_close` accepts, and how many of them were found to 0.5 px.
template <typename IsClose>
std::pair<int, int> countClose(const std::vector<observation::Corner>& corners,
                               const std::vector<simulation::TrueCorner>& truth, const IsClose& is_close) {
  std::map<int, Eigen::Vector2d> found_px;
  for (const observation::Corner& corner : corners) {
    found_px[corner.corner_id] = corner.px;
  }
  std::pair<int, int> count{0, 0};
  for (const simulation::TrueCorner& corner : truth) {
    if (corner.visible && corner.neighbour_distance_px >= 4.0 && is_close(corner.px)) {
      ++count.first;
      const auto found = found_px.find(corner.corner_id);
      count.second += found != found_px.end() && (found->second - corner.px).norm() < 0.5 ? 1 : 0;
    }
  }
  return count;
}

TEST(CornerRecoveryTest, FindsCornersWhoseSurroundingsLeaveTheImage) {
  const target::AprilGrid grid;
  constexpr double kWindow_px = 13.0;  // of the larger tags here: what is looked at around a corner
  constexpr double kNeeded_px = 7.0;
  std::pair<int, int> count{0, 0};
  for (int k = 0; k < 9; ++k) {
    BoardScene scene(test_support::fisheyeCamera(640, 480, 280.0));
    const BoardPose pose{0.35 + 0.02 * k, 38.0 * kDegree, 1.0 * k, 0.2, -0.1, 0.3 * k};
    const auto truth = scene.add(grid, pose);
    const auto corners =
        CornerRecovery(grid).recover(scene.expose(0.7, 2.0), flatBoardMap(scene.camera(), test_support::poseOf(grid, pose)));
    const auto close = countClose(corners, truth, [&](const Eigen::Vector2d& px) {
      const double border_px = std::min({px.x(), px.y(), 639.0 - px.x(), 479.0 - px.y()});
      return border_px > kNeeded_px && border_px < kWindow_px;
    });
    count.first += close.first;
    count.second += close.second;
    EXPECT_EQ(recoveryScore(corners, truth).wrong, 0);
  }
  EXPECT_GT(count.first, 20);
  EXPECT_GE(count.second, 0.95 * count.first) << "of " << count.first;
}

TEST(CornerRecoveryTest, FindsCornersBesideTheLensCircle) {
  const target::AprilGrid grid;
  constexpr double kNeeded_px = 4.0;
  constexpr double kWindow_px = 10.0;
  std::pair<int, int> count{0, 0};
  for (int k = 0; k < 8; ++k) {
    BoardScene scene(fisheye());
    BoardPose pose = kAtTheRim;
    pose.azimuth_rad += 0.8 * k;
    pose.roll_rad += 0.5 * k;
    const auto truth = scene.add(grid, pose);
    const Eigen::Vector2d centre_px(499.5, 499.5);
    constexpr double kCircle_px = 405.0;
    cv::Mat1f outside(scene.grey().size(), 1.0F);
    cv::circle(outside, cv::Point(500, 500), static_cast<int>(kCircle_px), 0.0F, cv::FILLED);
    scene.grey().setTo(0.0, outside > 0.5F);
    const auto corners =
        CornerRecovery(grid).recover(scene.expose(0.7, 2.0), flatBoardMap(scene.camera(), test_support::poseOf(grid, pose)));
    const auto rim_px = [&](const Eigen::Vector2d& px) { return kCircle_px - (px - centre_px).norm(); };
    const auto close = countClose(
        corners, truth, [&](const Eigen::Vector2d& px) { return rim_px(px) > kNeeded_px && rim_px(px) < kWindow_px; });
    count.first += close.first;
    count.second += close.second;
    for (const observation::Corner& corner : corners) {
      EXPECT_GT(rim_px(corner.px), 0.0) << corner.corner_id;
    }
  }
  EXPECT_GT(count.first, 20);
  EXPECT_GE(count.second, 0.85 * count.first) << "of " << count.first;
}

TEST(CornerRecoveryTest, ABoardElsewhereGivesNothing) {
  const target::AprilGrid grid;
  BoardScene scene(fisheye());
  scene.add(grid, kAtTheRim);
  BoardPose other = kAtTheRim;
  other.azimuth_rad += 90.0 * kDegree;
  EXPECT_TRUE(CornerRecovery(grid)
                  .recover(scene.expose(0.7, 2.0), flatBoardMap(scene.camera(), test_support::poseOf(grid, other)))
                  .empty());
  other = kAtTheRim;
  other.roll_rad += 90.0 * kDegree;  // the same place, turned: every X-corner is there, with another id
  EXPECT_TRUE(CornerRecovery(grid)
                  .recover(scene.expose(0.7, 2.0), flatBoardMap(scene.camera(), test_support::poseOf(grid, other)))
                  .empty());
}

TEST(CornerRecoveryTest, AnotherBoardAtThePredictedPlaceGivesNothing) {
  target::AprilGrid other;
  other.code_offset = 40;
  BoardScene scene(fisheye());
  scene.add(other, kAtTheRim);
  const target::AprilGrid grid;
  const BoardMap map = flatBoardMap(scene.camera(), test_support::poseOf(grid, kAtTheRim));
  EXPECT_TRUE(CornerRecovery(grid).recover(scene.expose(0.7, 2.0), map).empty());
}

TEST(CornerRecoveryTest, CheckerboardsAreFoundWhicheverWayRoundTheyArePrinted) {
  const target::Checkerboard board{7, 10, 0.05, 0.05};
  BoardScene scene(fisheye());
  const BoardPose pose{0.4, 50.0 * kDegree, 0.4, 10.0 * kDegree, -15.0 * kDegree, 20.0 * kDegree};
  const auto truth = scene.add(board, pose);
  const BoardMap map = flatBoardMap(scene.camera(), test_support::poseOf(board, pose));
  cv::Mat image = scene.expose(0.7, 2.0);
  for (const bool inverted : {false, true}) {
    const cv::Mat seen = inverted ? cv::Mat(255 - image) : image;
    const RecoveryScore result = recoveryScore(CornerRecovery(board).recover(seen, map), truth);
    EXPECT_GE(result.found, 0.98 * result.expected) << "of " << result.expected << (inverted ? " inverted" : "");
    EXPECT_EQ(result.wrong, 0);
  }
}

TEST(CornerRecoveryTest, QuadrilateralsSayLessAndNothingWrong) {
  const target::AprilGrid grid;
  RecoveryOptions quads;
  quads.filter = CornerFilter::kQuads;
  for (const double polar_deg : {10.0, 50.0, 75.0}) {
    BoardScene scene(fisheye());
    const BoardPose pose{0.5, polar_deg * kDegree, 0.4, 10.0 * kDegree, -15.0 * kDegree, 20.0 * kDegree};
    const auto truth = scene.add(grid, pose);
    cv::circle(scene.grey(), cv::Point(static_cast<int>(truth[60].px.x()), static_cast<int>(truth[60].px.y())), 40, 150.0F,
               cv::FILLED);
    const cv::Mat image = scene.expose(0.7, 2.0);
    const BoardMap map = flatBoardMap(scene.camera(), test_support::poseOf(grid, pose));
    const RecoveryScore by_quads = recoveryScore(CornerRecovery(grid, quads).recover(image, map), truth);
    const RecoveryScore by_image = recoveryScore(CornerRecovery(grid).recover(image, map), truth);
    EXPECT_GT(by_quads.found, 20) << polar_deg;
    EXPECT_LT(by_quads.found, by_image.found) << polar_deg;
    EXPECT_EQ(by_quads.wrong, 0) << polar_deg;
  }
}

TEST(CornerRecoveryTest, QuadrilateralsNeedTags) {
  RecoveryOptions quads;
  quads.filter = CornerFilter::kQuads;
  EXPECT_THROW(CornerRecovery(target::Checkerboard{7, 10, 0.05, 0.05}, quads), InputError);
}

TEST(CornerRecoveryTest, AnImageWithoutABoardGivesNothing) {
  const target::AprilGrid grid;
  const BoardScene scene(fisheye());
  const BoardMap map = flatBoardMap(scene.camera(), test_support::poseOf(grid, kAtTheRim));
  EXPECT_TRUE(CornerRecovery(grid).recover(scene.expose(0.7, 3.0), map).empty());
}

}  // namespace
}  // namespace tartan_calib::detection
