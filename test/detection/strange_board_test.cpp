#include <gtest/gtest.h>

#include <opencv2/core.hpp>

#include "detection/detection_score.h"
#include "support/board_scene.h"
#include "tartan_calib/detection/target_detector.h"

/// Boards that are not the target, or the target more than once.
namespace tartan_calib::detection {
namespace {

using test_support::BoardPose;
using test_support::BoardScene;
using test_support::kDegree;

const BoardPose kTilted = {1.1, 5.0 * kDegree, 1.0, 20.0 * kDegree, -25.0 * kDegree, 30.0 * kDegree};

camera::Camera vga() { return test_support::pinholeCamera(640, 480, 500.0); }

TEST(AprilGridDetector, recognisesABoardWithTheOtherBorder) {
  for (const int printed : {1, 2}) {
    target::AprilGrid printed_grid;
    printed_grid.border_cells = printed;
    target::AprilGrid expected_grid;
    expected_grid.border_cells = 3 - printed;
    BoardScene scene(vga());
    scene.add(printed_grid, kTilted);
    const Detection detection = TargetDetector(expected_grid).detect(scene.expose(0.6, 2.0));
    EXPECT_TRUE(detection.corners.empty());
    EXPECT_GE(detection.counts.other_border_tags, 30);
  }
}

TEST(AprilGridDetector, namesTheSizeOfABoardWithAnotherNumberOfColumns) {
  target::AprilGrid printed;
  printed.tag_rows = 5;
  printed.tag_cols = 7;
  BoardScene scene(vga());
  scene.add(printed, kTilted);
  for (const int stated_cols : {5, 6, 8}) {
    target::AprilGrid stated = printed;
    stated.tag_cols = stated_cols;
    const Detection detection = TargetDetector(stated).detect(scene.expose(0.6, 2.0));
    EXPECT_TRUE(detection.corners.empty()) << stated_cols;
    EXPECT_EQ(detection.counts.other_sizes, (std::map<BoardSize, int>{{{5, 7}, 1}})) << stated_cols;
  }
  EXPECT_TRUE(TargetDetector(printed).detect(scene.expose(0.6, 2.0)).counts.other_sizes.empty());
}

TEST(AprilGridDetector, recognisesAMirroredBoard) {
  const target::AprilGrid grid;
  BoardScene scene(vga());
  scene.add(grid, kTilted);
  cv::Mat mirrored;
  cv::flip(scene.expose(0.6, 2.0), mirrored, 1);
  const Detection detection = TargetDetector(grid).detect(mirrored);
  EXPECT_TRUE(detection.corners.empty());
  EXPECT_GE(detection.counts.mirrored_tags, 30);
}

TEST(AprilGridDetector, dropsAndCountsTheTagsOfTwoEqualBoards) {
  const target::AprilGrid grid;
  BoardScene scene(test_support::pinholeCamera(1000, 480, 450.0));
  scene.add(grid, {1.1, 22.0 * kDegree, 0.0, 0.0, 10.0 * kDegree, 0.1});
  scene.add(grid, {1.1, 22.0 * kDegree, 180.0 * kDegree, 10.0 * kDegree, 0.0, 0.5});
  const Detection detection = TargetDetector(grid).detect(scene.expose(0.6, 2.0));
  EXPECT_TRUE(detection.corners.empty());
  EXPECT_EQ(detection.counts.tags, 0);
  EXPECT_GE(detection.counts.duplicate_tags, 70);
}

TEST(AprilGridDetector, keepsOnlyTheTagsThatOneBoardAloneShows) {
  const target::AprilGrid grid;
  BoardScene scene(test_support::pinholeCamera(1000, 480, 450.0));
  const auto truth = scene.add(grid, {1.1, 22.0 * kDegree, 0.0, 0.0, 10.0 * kDegree, 0.1});
  scene.add(grid, {1.1, 46.0 * kDegree, 180.0 * kDegree, 10.0 * kDegree, 0.0, 0.5});  // in part out of the image
  const Detection detection = TargetDetector(grid).detect(scene.expose(0.6, 2.0));
  EXPECT_EQ(score(detection, truth).wrong, 0);
  EXPECT_GT(detection.counts.duplicate_tags, 10);
  EXPECT_GT(detection.counts.tags, 5);
  EXPECT_EQ(detection.counts.duplicate_tags / 2 + detection.counts.tags, 36);
}

TEST(AprilGridDetector, isNotDisturbedByABoardWithOtherIds) {
  const target::AprilGrid grid;
  target::AprilGrid other = grid;
  other.code_offset = 100;
  BoardScene scene(test_support::pinholeCamera(1000, 480, 450.0));
  const auto truth = scene.add(grid, {1.1, 22.0 * kDegree, 0.0, 0.0, 10.0 * kDegree, 0.1});
  scene.add(other, {1.1, 22.0 * kDegree, 180.0 * kDegree, 10.0 * kDegree, 0.0, 0.5});
  const Detection detection = TargetDetector(grid).detect(scene.expose(0.6, 2.0));
  const Score result = score(detection, truth);
  EXPECT_EQ(result.found, 144);
  EXPECT_EQ(result.wrong, 0);
  EXPECT_GE(detection.counts.foreign_tags, 35);
}

}  // namespace
}  // namespace tartan_calib::detection
