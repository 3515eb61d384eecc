#include "tartan_calib/simulation/still.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <iostream>
#include <opencv2/core.hpp>

#include "tartan_calib/error.h"
#include "tartan_calib/simulation/board_layer.h"
#include "tartan_calib/simulation/board_pattern.h"
#include "tartan_calib/target/tag_family.h"

namespace tartan_calib::simulation {
namespace {

constexpr double kMarginM = 0.05;

/// A 195-degree fisheye.
camera::Camera fisheye() {
  camera::DoubleSphere::Parameters parameters;
  parameters << -0.1721, 0.5931, 316.6, 316.5, 510.4, 514.3;
  return {camera::DoubleSphere(parameters), 1024, 1024};
}

/// Centre of the board at `distance_m` in the direction (polar, azimuth), facing the camera but for a tilt.
geometry::Rigid3 pose(double polar_rad, double azimuth_rad, double distance_m) {
  const Eigen::Vector3d axis(-std::sin(azimuth_rad), std::cos(azimuth_rad), 0.0);
  const Eigen::Quaterniond aim = geometry::expRotation(polar_rad * axis);
  const Eigen::Quaterniond facing(Eigen::AngleAxisd(M_PI, Eigen::Vector3d::UnitX()));
  const Eigen::Quaterniond tilt = geometry::expRotation({0.3, -0.4, 0.2});
  const Eigen::Quaterniond R_cam_target = aim * tilt * facing;
  const Eigen::Vector3d centre_target(0.33, 0.33, 0.0);
  return geometry::Rigid3(R_cam_target, aim * Eigen::Vector3d(0.0, 0.0, distance_m) - R_cam_target * centre_target);
}

/// White part of a pixel by 64 x 64 rays, with none of the renderer's code: unproject, meet the plane, look the cell up.
double whiteByRays(const BoardPattern& pattern, const camera::Camera& camera, const geometry::Rigid3& T_target_cam,
                   const Eigen::Vector2d& px) {
  constexpr int kRays = 64;
  int white = 0;
  for (int i = 0; i < kRays * kRays; ++i) {
    const int ray_row = i / kRays;
    const Eigen::Vector2d offset((i % kRays + 0.5) / kRays - 0.5, (ray_row + 0.5) / kRays - 0.5);
    const Eigen::Vector3d ray = T_target_cam.rotation * *camera::unproject(camera.model, px + offset);
    const Eigen::Vector3d hit = T_target_cam.translation - T_target_cam.translation.z() / ray.z() * ray;
    const auto cell = [](const std::vector<double>& lines, double at) {
      return static_cast<int>(std::upper_bound(lines.begin(), lines.end(), at) - lines.begin()) - 1;
    };
    const int col = cell(pattern.x_lines_m, hit.x());
    const int row = cell(pattern.y_lines_m, hit.y());
    const bool on_sheet = col >= 0 && row >= 0 && col < pattern.numCols() && row < pattern.numRows();
    white += on_sheet && !pattern.isBlack(col, row) ? 1 : 0;
  }
  return static_cast<double>(white) / (kRays * kRays);
}

/// How far the drawn pixels around a corner pull a least-squares position of it away from where the rays' pixels put it.
Eigen::Vector2d pull(const cv::Mat1f& white, const BoardPattern& pattern, const camera::Camera& camera,
                     const geometry::Rigid3& T_target_cam, const Eigen::Vector2d& corner_px) {
  constexpr int kRadiusPx = 3;
  const int u = static_cast<int>(std::lround(corner_px.x()));
  const int v = static_cast<int>(std::lround(corner_px.y()));
  Eigen::Matrix2d normal = Eigen::Matrix2d::Zero();
  Eigen::Vector2d right = Eigen::Vector2d::Zero();
  for (int row = v - kRadiusPx; row <= v + kRadiusPx; ++row) {
    for (int col = u - kRadiusPx; col <= u + kRadiusPx; ++col) {
      const Eigen::Vector2d gradient(0.5 * (white(row, col + 1) - white(row, col - 1)),
                                     0.5 * (white(row + 1, col) - white(row - 1, col)));
      const double error = white(row, col) - whiteByRays(pattern, camera, T_target_cam, {col, row});
      normal += gradient * gradient.transpose();
      right += gradient * error;
    }
  }
  return -normal.inverse() * right;
}

TEST(DrawBoard, movesNoCornerByMoreThanFiveThousandthsOfAPixel) {
  const camera::Camera camera = fisheye();
  const target::AprilGrid grid;
  const BoardPattern pattern = boardPattern(grid, kMarginM);
  double sum_px2 = 0.0;
  int count = 0;
  for (const double polar_rad : {0.1, 0.8, 1.4}) {
    const geometry::Rigid3 T_cam_target = pose(polar_rad, 2.0 * polar_rad, 0.6);
    const BoardLayer board = drawBoard(pattern, camera, T_cam_target);
    cv::Mat1f white(camera.height, camera.width, 0.0F);
    board.white.copyTo(white(board.window));
    for (const TrueCorner& corner : projectCorners(grid, camera, T_cam_target)) {
      if (corner.corner_id % 16 == 5 && corner.visible && corner.neighbour_distance_px > 8.0) {
        sum_px2 += pull(white, pattern, camera, T_cam_target.inverse(), corner.px).squaredNorm();
        ++count;
      }
    }
  }
  ASSERT_GE(count, 20);
  const double rms_px = std::sqrt(sum_px2 / count);
  RecordProperty("rms_px", std::to_string(rms_px));
  std::cout << "corner error of the renderer: " << rms_px << " px rms over " << count << " corners\n";
  EXPECT_LT(rms_px, 0.005);
}

TEST(DrawBoard, showsAWhiteBackFromBehind) {
  const camera::Camera camera = fisheye();
  const geometry::Rigid3 T_cam_target(Eigen::Quaterniond::Identity(), Eigen::Vector3d(-0.3, -0.3, 0.6));
  const BoardLayer board = drawBoard(boardPattern(target::AprilGrid(), kMarginM), camera, T_cam_target);
  ASSERT_FALSE(board.window.empty());
  EXPECT_GT(cv::sum(board.sheet)[0], 1e4);
  EXPECT_LT(cv::norm(board.sheet, board.white, cv::NORM_INF), 1e-5);
  EXPECT_TRUE(projectCorners(target::AprilGrid(), camera, T_cam_target).empty());
}

TEST(DrawBoard, isEmptyWhereTheBoardIsOutOfView) {
  const geometry::Rigid3 T_cam_target = pose(M_PI, 0.0, 1.0);
  EXPECT_TRUE(drawBoard(boardPattern(target::AprilGrid(), kMarginM), fisheye(), T_cam_target).window.empty());
  const Still still = renderStill(target::AprilGrid(), fisheye(), T_cam_target);
  EXPECT_EQ(still.image.at<unsigned char>(500, 500), 110);
  EXPECT_TRUE(still.corners.empty());
}

TEST(ProjectCorners, areTheCamerasOwnProjections) {
  const camera::Camera camera = fisheye();
  const geometry::Rigid3 T_cam_target = pose(1.5, 0.7, 0.5);  // reaches beyond the image
  const std::vector<Eigen::Vector3d> points = target::cornerPoints(target::AprilGrid());
  const std::vector<TrueCorner> corners = projectCorners(target::AprilGrid(), camera, T_cam_target);
  EXPECT_GT(corners.size(), 20U);
  EXPECT_LT(corners.size(), points.size());
  for (const TrueCorner& corner : corners) {
    const Eigen::Vector3d p_cam = T_cam_target * points[static_cast<std::size_t>(corner.corner_id)];
    EXPECT_EQ(corner.px, *camera::project(camera.model, p_cam));
    const bool clear = corner.px.minCoeff() >= 2.0 && corner.px.maxCoeff() <= 1021.0;
    EXPECT_EQ(corner.visible, clear);
  }
}

TEST(ProjectCorners, areVisibleFromTwoPixelsInsideOfEachBorder) {
  const geometry::Rigid3 T_cam_target = pose(0.1, 0.0, 0.6);
  const Eigen::Vector2d first = projectCorners(target::AprilGrid(), fisheye(), T_cam_target).front().px;
  const auto first_at = [&](const Eigen::Vector2d& px) {
    camera::Camera camera = fisheye();
    Eigen::VectorXd parameters = camera::parameters(camera.model);
    parameters.tail<2>() += px - first;
    camera.model = camera::withParameters(camera.model, parameters);
    return projectCorners(target::AprilGrid(), camera, T_cam_target).front();
  };
  for (const Eigen::Vector2d& px : {Eigen::Vector2d(1.9, 500.0), Eigen::Vector2d(1021.1, 500.0), Eigen::Vector2d(500.0, 1.9),
                                    Eigen::Vector2d(500.0, 1021.1)}) {
    const TrueCorner hidden = first_at(px);
    EXPECT_TRUE(hidden.corner_id == 0 && !hidden.visible) << px.transpose();
    const TrueCorner seen = first_at(px + 0.002 * (Eigen::Vector2d(500.0, 500.0) - px));
    EXPECT_TRUE(seen.corner_id == 0 && seen.visible) << px.transpose();
  }
}

TEST(BoardPattern, hasTagZeroUprightAtTheBottomLeftOfAnAprilGrid) {
  const target::AprilGrid grid;
  const BoardPattern pattern = boardPattern(grid, kMarginM);
  const target::TagFamily family = target::tagFamily("t36h11");
  ASSERT_EQ(pattern.numCols(), 6 * 11 + 3);
  for (int row = 0; row < 6; ++row) {
    for (int col = 0; col < 6; ++col) {
      // Two cells before the tag, two of border; rows count from the bottom.
      EXPECT_EQ(pattern.isBlack(4 + col, 4 + 5 - row), !target::isWhiteCell(family, 0, row, col)) << row << " " << col;
    }
  }
  EXPECT_TRUE(pattern.isBlack(1, 1)) << "square at the tag's outer corner";
  EXPECT_FALSE(pattern.isBlack(0, 0)) << "margin";
}

TEST(BoardPattern, hasItsLinesThroughTheCorners) {
  for (const target::Target& target : {target::Target(target::AprilGrid{4, 7, 0.05, 0.25, "t25h9", 0, 1}),
                                       target::Target(target::Checkerboard{7, 10, 0.03, 0.04})}) {
    const BoardPattern pattern = boardPattern(target, kMarginM);
    const auto is_line = [](const std::vector<double>& lines, double at) {
      return std::any_of(lines.begin(), lines.end(), [at](double line) { return std::abs(line - at) < 1e-12; });
    };
    for (const Eigen::Vector3d& corner : target::cornerPoints(target)) {
      EXPECT_TRUE(is_line(pattern.x_lines_m, corner.x()) && is_line(pattern.y_lines_m, corner.y())) << corner.transpose();
    }
  }
}

TEST(BoardPattern, refusesBoardsThatCannotBePrinted) {
  target::AprilGrid grid;
  grid.code_offset = 580;
  EXPECT_THROW(boardPattern(grid, kMarginM), InputError);
  EXPECT_THROW(boardPattern(target::CircleGrid{4, 5, 0.05, false}, kMarginM), InputError);
}

TEST(RenderStill, isTheSameForTheSameSeedAndHasTheNoiseAskedFor) {
  StillOptions options;
  options.noise_sigma = 3.0;
  const geometry::Rigid3 away = pose(M_PI, 0.0, 1.0);
  const cv::Mat first = renderStill(target::AprilGrid(), fisheye(), away, options).image;
  EXPECT_EQ(cv::norm(first, renderStill(target::AprilGrid(), fisheye(), away, options).image, cv::NORM_INF), 0.0);
  cv::Scalar mean;
  cv::Scalar sigma;
  cv::meanStdDev(first, mean, sigma);
  EXPECT_NEAR(mean[0], options.background_grey, 0.02);
  EXPECT_NEAR(sigma[0], std::sqrt(9.0 + 1.0 / 12.0), 0.02) << "noise and rounding, over a million pixels";
  options.seed = 2;
  EXPECT_GT(cv::norm(first, renderStill(target::AprilGrid(), fisheye(), away, options).image, cv::NORM_INF), 0.0);
}

}  // namespace
}  // namespace tartan_calib::simulation
