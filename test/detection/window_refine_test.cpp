#include "tartan_calib/detection/window_refine.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "support/board_scene.h"
#include "tartan_calib/camera/camera.h"

namespace tartan_calib::detection {
namespace {

using simulation::TrueCorner;
using test_support::BoardScene;
using test_support::kDegree;

constexpr double kPxPerMetre = 100.0;

/// Looks straight at the board.
std::optional<Eigen::Vector2d> flatMap(const Eigen::Vector2d& p_target_m) { return kPxPerMetre * p_target_m; }

TEST(AdaptiveHalfWindow, isAShareOfTheDistanceBetweenItsBounds) {
  EXPECT_EQ(adaptiveHalfWindow(12.4, {}), 4);
  EXPECT_EQ(adaptiveHalfWindow(3.0, {}), 2);
  EXPECT_EQ(adaptiveHalfWindow(100.0, {}), 8);
  EXPECT_EQ(adaptiveHalfWindow(std::numeric_limits<double>::infinity(), {}), 8);
  EXPECT_EQ(adaptiveHalfWindow(40.0, {0.25, 1, 20}), 10);
}

TEST(CornerNeighbours, areAGapAwayForEveryCornerOfATagGridItsRimIncluded) {
  const target::AprilGrid grid;
  const CornerNeighbours neighbours(grid);
  const double gap_px = kPxPerMetre * grid.tag_spacing_ratio * grid.tag_size_m;
  for (int id = 0; id < target::numCorners(grid); ++id) {
    EXPECT_NEAR(neighbours.nearest_px(flatMap, id), gap_px, 1e-9) << id;
  }
}

TEST(CornerNeighbours, areTheNearerSpacingOfACheckerboard) {
  const target::Checkerboard board{4, 6, 0.03, 0.05};
  const CornerNeighbours neighbours(board);
  for (int id = 0; id < target::numCorners(board); ++id) {
    EXPECT_NEAR(neighbours.nearest_px(flatMap, id), kPxPerMetre * 0.03, 1e-9) << id;
  }
}

TEST(CornerNeighbours, shrinkWithTheForeshorteningOfTheBoard) {
  const target::AprilGrid grid;
  const BoardMap tilted = [](const Eigen::Vector2d& p) {
    return std::make_optional<Eigen::Vector2d>(40.0 * p.x(), 100.0 * p.y());
  };
  EXPECT_NEAR(CornerNeighbours(grid).nearest_px(tilted, 60), 40.0 * 0.3 * 0.088, 1e-9);
}

struct Picture {
  Picture() : scene(test_support::pinholeCamera(640, 480, 500.0)) {
    corners = scene.add(target::AprilGrid{}, {1.1, 3.0 * kDegree, 1.0, 20.0 * kDegree, -25.0 * kDegree, 0.5});
  }

  BoardScene scene;
  std::vector<TrueCorner> corners;
};

TEST(RefineInWindow, findsCornersToATenthOfAPixelAndSaysHowWell) {
  const Picture picture;
  // Bent gradients of a blurred corner count as noise: of noise itself the covariance says three to six times too much where
  // there is little.
  struct Level {
    double noise_grey;
    double rms_px;
    double normalized;
  };
  for (const Level& level : {Level{2.0, 0.042, 0.19}, Level{8.0, 0.114, 0.50}}) {
    const cv::Mat image = picture.scene.expose(0.7, level.noise_grey);
    double squared_px2 = 0.0;
    double normalized2 = 0.0;
    for (const TrueCorner& corner : picture.corners) {
      const auto refined = refineInWindow(image, corner.px + Eigen::Vector2d(0.3, -0.2), {3, 40, 0.03, 2.0});
      ASSERT_TRUE(refined) << corner.corner_id;
      const Eigen::Vector2d error_px = refined->px - corner.px;
      EXPECT_LT(error_px.norm(), level.noise_grey < 5.0 ? 0.11 : 0.26) << corner.corner_id;
      squared_px2 += error_px.squaredNorm();
      normalized2 += 0.5 * error_px.dot(refined->cov_px2.inverse() * error_px);
    }
    const auto count = static_cast<double>(picture.corners.size());
    EXPECT_NEAR(std::sqrt(squared_px2 / count), level.rms_px, 0.1 * level.rms_px) << level.noise_grey;
    EXPECT_NEAR(std::sqrt(normalized2 / count), level.normalized, 0.15 * level.normalized) << level.noise_grey;
  }
}

TEST(RefineInWindow, takesASmallerWindowAtTheBorderOfTheImage) {
  const Picture picture;
  const cv::Mat image = picture.scene.expose(0.7, 1.0);
  const Eigen::Vector2d corner_px = picture.corners.at(60).px;
  const int left = static_cast<int>(corner_px.x()) - 2;
  const auto refined =
      refineInWindow(image.colRange(left, image.cols).clone(), corner_px - Eigen::Vector2d(left, 0.0), {8, 40, 0.03, 2.0});
  ASSERT_TRUE(refined);
  EXPECT_LT((refined->px + Eigen::Vector2d(left, 0.0) - corner_px).norm(), 0.3);
  EXPECT_FALSE(refineInWindow(image, {1.0, 100.0}, {}));
}

TEST(RefineInWindow, givesNothingFurtherAwayThanAllowed) {
  const Picture picture;
  const cv::Mat image = picture.scene.expose(0.7, 1.0);
  const Eigen::Vector2d start_px = picture.corners.at(60).px + Eigen::Vector2d(1.0, 0.9);
  EXPECT_FALSE(refineInWindow(image, start_px, {4, 40, 0.03, 1.0}));
  EXPECT_TRUE(refineInWindow(image, start_px, {4, 40, 0.03, 2.0}));
}

}  // namespace
}  // namespace tartan_calib::detection
