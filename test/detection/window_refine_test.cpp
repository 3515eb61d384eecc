#include "tartan_calib/detection/window_refine.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "support/board_scene.h"
#include "tartan_calib/camera/camera.h"
#include "tartan_calib/median.h"

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
  explicit Picture(double distance_m = 1.1) : scene(test_support::pinholeCamera(640, 480, 500.0)) {
    corners = scene.add(target::AprilGrid{}, {distance_m, 3.0 * kDegree, 1.0, 20.0 * kDegree, -25.0 * kDegree, 0.5});
  }

  BoardScene scene;
  std::vector<TrueCorner> corners;
};

TEST(RefineInWindow, findsCornersToATenthOfAPixel) {
  const Picture picture;
  struct Level {
    double noise_grey;
    double rms_px;
  };
  for (const Level& level : {Level{2.0, 0.042}, Level{8.0, 0.114}}) {
    const cv::Mat image = picture.scene.expose(0.7, level.noise_grey);
    double squared_px2 = 0.0;
    for (const TrueCorner& corner : picture.corners) {
      const auto refined = refineInWindow(image, corner.px + Eigen::Vector2d(0.3, -0.2), {3, 40, 0.03, 2.0});
      ASSERT_TRUE(refined) << corner.corner_id;
      const Eigen::Vector2d error_px = refined->px - corner.px;
      EXPECT_LT(error_px.norm(), level.noise_grey < 5.0 ? 0.11 : 0.26) << corner.corner_id;
      squared_px2 += error_px.squaredNorm();
    }
    const auto count = static_cast<double>(picture.corners.size());
    EXPECT_NEAR(std::sqrt(squared_px2 / count), level.rms_px, 0.1 * level.rms_px) << level.noise_grey;
  }
}

/// Robust standard deviation, per axis, of errors in units of the one that is stated: of all corners of four pictures that
/// differ in noise.
double normalizedDeviation(double blur_px, double noise_grey, const WindowRefineOptions& options) {
  constexpr int kNumPictures = 4;
  constexpr double kDeviationPerMedian = 1.4826;  // of the absolute values of normally distributed ones
  const Picture picture(0.8);
  std::vector<double> magnitudes;
  for (int seed = 1; seed <= kNumPictures; ++seed) {
    const cv::Mat image = picture.scene.expose(blur_px, noise_grey, static_cast<std::uint64_t>(seed));
    for (const TrueCorner& corner : picture.corners) {
      const auto refined = refineInWindow(image, corner.px + Eigen::Vector2d(0.2, -0.15), options);
      if (corner.visible && refined) {
        const Eigen::Vector2d normalized = refined->cov_px2.llt().matrixL().solve(refined->px - corner.px);
        magnitudes.insert(magnitudes.end(), {std::abs(normalized.x()), std::abs(normalized.y())});
      }
    }
  }
  EXPECT_GT(magnitudes.size(), 1000U);
  return kDeviationPerMedian * upperMedian(magnitudes);
}

TEST(RefineInWindow, statesTheCovarianceThatItsErrorsHave) {
  struct Case {
    WindowRefineOptions options;
    double blur_px;
  };
  const WindowRefineOptions kalibr;
  const WindowRefineOptions small{3, 40, 0.03, 4.2};
  const WindowRefineOptions large{6, 40, 0.03, 8.5};
  for (const Case& window : {Case{kalibr, 0.5}, Case{kalibr, 0.8}, Case{small, 0.5}, Case{small, 0.8}, Case{small, 1.2},
                             Case{large, 0.5}, Case{large, 0.8}, Case{large, 1.5}}) {
    for (const double noise_grey : {1.0, 3.0, 8.0}) {
      // Where bilinear samples shift the corner by more than the noise does, the errors are not normally distributed.
      EXPECT_NEAR(normalizedDeviation(window.blur_px, noise_grey, window.options), 1.0, 0.12)
          << "half window " << window.options.half_window_px << ", blur " << window.blur_px << ", noise " << noise_grey;
    }
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
