#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "tartan_calib/detection/target_detector.h"

namespace tartan_calib::detection {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr int kSide_px = 800;

/// A board seen by a pinhole camera, slightly tilted.
struct View {
  double turn_rad = 0.0;
  /// The side that faces the camera: +1 shows the board as x right, y up; -1 from behind, as x right, y down.
  double facing = 1.0;

  Eigen::Vector2d px(const Eigen::Vector2d& centred_m) const {
    constexpr double kFocalLength_px = 700.0;
    constexpr double kTilt = 0.25;
    const Eigen::Vector2d seen(centred_m.x(), -facing * centred_m.y());
    const Eigen::Vector2d turned(std::cos(turn_rad) * seen.x() - std::sin(turn_rad) * seen.y(),
                                 std::sin(turn_rad) * seen.x() + std::cos(turn_rad) * seen.y());
    const double depth_m = 1.0 + kTilt * turned.x();
    return kFocalLength_px * turned / depth_m + Eigen::Vector2d::Constant(0.5 * kSide_px);
  }
};

std::vector<Eigen::Vector2d> centresInView(const target::CircleGrid& grid, const View& view) {
  const auto points = target::cornerPoints(grid);
  const Eigen::Vector3d middle = 0.5 * (points.front() + points.back());
  std::vector<Eigen::Vector2d> centres_px;
  for (const Eigen::Vector3d& point : points) {
    centres_px.push_back(view.px((point - middle).head<2>()));
  }
  return centres_px;
}

cv::Mat drawCircles(const std::vector<Eigen::Vector2d>& centres_px, int radius_px) {
  constexpr int kFractionBits = 4;
  constexpr double kUnits = 1 << kFractionBits;
  cv::Mat image(kSide_px, kSide_px, CV_8UC1, cv::Scalar(220));
  for (const Eigen::Vector2d& px : centres_px) {
    const cv::Point centre(static_cast<int>(std::lround(kUnits * px.x())), static_cast<int>(std::lround(kUnits * px.y())));
    cv::circle(image, centre, static_cast<int>(kUnits * radius_px), cv::Scalar(20), cv::FILLED, cv::LINE_AA, kFractionBits);
  }
  cv::GaussianBlur(image, image, cv::Size(), 1.0);
  return image;
}

/// True if the corners are the drawn centres in the order of their ids, or in another order under which the board looks the
/// same and is not mirrored.
bool isNumberedAsSomeTurn(const target::CircleGrid& grid, const Detection& detection,
                          const std::vector<Eigen::Vector2d>& truth_px) {
  const auto turned_id = [&grid](int id, int quarter_turns) {
    const int row = id / grid.cols;
    const int col = id % grid.cols;
    const std::array<int, 4> turned{id, (grid.cols - 1 - col) * grid.rows + row,
                                    (grid.rows - 1 - row) * grid.cols + grid.cols - 1 - col,
                                    col * grid.rows + grid.rows - 1 - row};
    return static_cast<std::size_t>(turned[static_cast<std::size_t>(quarter_turns)]);
  };
  for (int quarter_turns = 0; quarter_turns < 4; quarter_turns += grid.rows == grid.cols && !grid.asymmetric ? 1 : 2) {
    bool fits = detection.corners.size() == truth_px.size();
    for (std::size_t id = 0; fits && id < truth_px.size(); ++id) {
      const std::size_t turned = turned_id(static_cast<int>(id), quarter_turns);
      fits = (detection.corners[turned].px - truth_px[id]).norm() < 0.5;
    }
    if (fits) {
      return true;
    }
  }
  return false;
}

class CircleGrid : public testing::TestWithParam<target::CircleGrid> {};

TEST_P(CircleGrid, isNumberedAsTheTargetHoweverItIsTurned) {
  const target::CircleGrid grid = GetParam();
  const TargetDetector detector(grid);
  for (int turn_deg = 0; turn_deg < 360; turn_deg += 30) {
    // Kalibr's asymmetric grid has x along columns and y down rows, so that its z axis points away from the viewer.
    const View view{turn_deg * kPi / 180.0, grid.asymmetric ? -1.0 : 1.0};
    const auto truth_px = centresInView(grid, view);
    EXPECT_TRUE(isNumberedAsSomeTurn(grid, detector.detect(drawCircles(truth_px, 9)), truth_px)) << turn_deg;
  }
}

INSTANTIATE_TEST_SUITE_P(, CircleGrid,
                         testing::Values(target::CircleGrid{5, 7, 0.08, false}, target::CircleGrid{7, 4, 0.08, false},
                                         target::CircleGrid{6, 6, 0.08, false}, target::CircleGrid{11, 4, 0.05, true},
                                         target::CircleGrid{10, 4, 0.05, true}, target::CircleGrid{7, 5, 0.05, true}),
                         [](const auto& grid) {
                           return std::to_string(grid.param.rows) + "x" + std::to_string(grid.param.cols) +
                                  (grid.param.asymmetric ? "asymmetric" : "symmetric");
                         });

TEST(CircleGridDetector, findsCirclesOfAnySize) {
  const target::CircleGrid grid{4, 6, 0.15, false};
  const auto truth_px = centresInView(grid, {});
  // 45 px of radius are more than OpenCV's own limit of 5000 px2.
  EXPECT_TRUE(isNumberedAsSomeTurn(grid, TargetDetector(grid).detect(drawCircles(truth_px, 45)), truth_px));
}

TEST(CircleGridDetector, reportsNoPartOfAGrid) {
  const target::CircleGrid grid{5, 7, 0.08, false};
  auto truth_px = centresInView(grid, {});
  truth_px.pop_back();
  EXPECT_TRUE(TargetDetector(grid).detect(drawCircles(truth_px, 9)).corners.empty());
  EXPECT_TRUE(TargetDetector(grid).detect(drawCircles({}, 9)).corners.empty());
}

TEST(CircleGridDetector, leavesOutCirclesAtTheImagesBorder) {
  const target::CircleGrid grid{5, 7, 0.08, false};
  const auto truth_px = centresInView(grid, {});
  DetectorOptions options;
  options.min_border_distance_px = truth_px.front().minCoeff() + 1.0;
  const auto corners = TargetDetector(grid, options).detect(drawCircles(truth_px, 9)).corners;
  EXPECT_FALSE(corners.empty());
  for (const observation::Corner& corner : corners) {
    EXPECT_GE(corner.px.minCoeff(), options.min_border_distance_px);
  }
}

}  // namespace
}  // namespace tartan_calib::detection
