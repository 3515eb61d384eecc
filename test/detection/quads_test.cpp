#include <gtest/gtest.h>

#include <algorithm>

#include "../../src/detection/quad_finder.h"
#include "../../src/detection/quad_match.h"
#include "support/board_scene.h"

namespace tartan_calib::detection {
namespace {

using test_support::BoardPose;
using test_support::BoardScene;

/// Predicted corners of a board that the camera sees, by id.
std::vector<std::optional<Eigen::Vector2d>> predictions(const std::vector<simulation::TrueCorner>& corners) {
  std::vector<std::optional<Eigen::Vector2d>> predicted(144);
  for (const simulation::TrueCorner& corner : corners) {
    predicted[static_cast<std::size_t>(corner.corner_id)] = corner.px;
  }
  return predicted;
}

constexpr double kThreshold_px = 1.41;

TEST(QuadsTest, EveryTagOfAStraightBoardIsFoundThoughSquaresJoinTheTags) {
  const target::AprilGrid grid;
  BoardScene scene(test_support::pinholeCamera(800, 600, 600.0));
  const auto truth = scene.add(grid, BoardPose{1.0, 0.0, 0.0, 0.3, 0.2, 0.1});
  const QuadCorners corners = matchQuads(findQuads(scene.expose(0.7, 2.0)), grid, predictions(truth), kThreshold_px);
  EXPECT_GE(corners.size(), 130U);
  for (const simulation::TrueCorner& corner : truth) {
    const auto found = corners.find(corner.corner_id);
    EXPECT_TRUE(found == corners.end() || (found->second - corner.px).norm() < kThreshold_px) << corner.corner_id;
  }
}

TEST(QuadsTest, AnImageWithoutABoardMatchesNothing) {
  const target::AprilGrid grid;
  BoardScene with(test_support::pinholeCamera(800, 600, 600.0));
  const auto truth = with.add(grid, BoardPose{1.0, 0.0, 0.0, 0.3, 0.2, 0.1});
  const BoardScene without(test_support::pinholeCamera(800, 600, 600.0));
  EXPECT_TRUE(matchQuads(findQuads(without.expose(0.7, 2.0)), grid, predictions(truth), kThreshold_px).empty());
}

/// Predictions of one tag: a square of 40 px.
std::vector<std::optional<Eigen::Vector2d>> oneTag(const target::AprilGrid& grid) {
  std::vector<std::optional<Eigen::Vector2d>> predicted(144);
  const std::vector<int> ids = target::tagCornerIds(grid, 7);
  const std::array<Eigen::Vector2d, 4> px = {
      {Eigen::Vector2d(100, 140), Eigen::Vector2d(140, 140), Eigen::Vector2d(140, 100), Eigen::Vector2d(100, 100)}};
  for (std::size_t i = 0; i < 4; ++i) {
    predicted[static_cast<std::size_t>(ids[i])] = px[i];
  }
  return predicted;
}

TEST(QuadsTest, CornersGetTheirNamesWhereverTheOutlineBeginsAndWhicheverWayItRuns) {
  const target::AprilGrid grid;
  const std::vector<int> ids = target::tagCornerIds(grid, 7);
  Quad quad = {Eigen::Vector2d(100.5, 140), {140, 140.5}, {140, 100}, {100, 100}};
  for (int direction = 0; direction < 2; ++direction) {
    for (int turn = 0; turn < 4; ++turn) {
      std::rotate(quad.begin(), quad.begin() + 1, quad.end());
      const QuadCorners corners = matchQuads({quad}, grid, oneTag(grid), kThreshold_px);
      ASSERT_EQ(corners.size(), 4U);
      EXPECT_EQ(corners.at(ids[0]), Eigen::Vector2d(100.5, 140));
      EXPECT_EQ(corners.at(ids[1]), Eigen::Vector2d(140, 140.5));
    }
    std::reverse(quad.begin(), quad.end());
  }
}

TEST(QuadsTest, OneCornerTooFarAwayRejectsAll) {
  const target::AprilGrid grid;
  const Quad quad = {Eigen::Vector2d(100, 140), {140, 140}, {142, 100}, {100, 100}};
  EXPECT_TRUE(matchQuads({quad}, grid, oneTag(grid), kThreshold_px).empty());
  EXPECT_EQ(matchQuads({quad}, grid, oneTag(grid), 2.5).size(), 4U);
}

TEST(QuadsTest, CornersOutOfOrderAreNoTag) {
  const target::AprilGrid grid;
  const Quad crossed = {Eigen::Vector2d(100, 140), {140, 100}, {140, 140}, {100, 100}};
  EXPECT_TRUE(matchQuads({crossed}, grid, oneTag(grid), kThreshold_px).empty());
}

}  // namespace
}  // namespace tartan_calib::detection
