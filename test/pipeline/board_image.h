#pragma once

#include <Eigen/Core>
#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "tartan_calib/geometry/rigid3.h"
#include "tartan_calib/target/tag_family.h"
#include "tartan_calib/target/target.h"

/// Simple pictures of an AprilGrid through a pinhole, good to some tenths of a pixel.
namespace tartan_calib::pipeline {

/// A pinhole whose principal point is in the middle.
struct Pinhole {
  double focal_px = 400.0;
  int width = 640;
  int height = 480;
};

constexpr int kPixelsPerCell = 6;
constexpr int kMarginCells = 5;

/// The sheet from above, y down, one tag being 10 cells wide (2 of border on each side).
inline cv::Mat drawSheet(const target::AprilGrid& grid) {
  constexpr int kTagCells = 10;
  constexpr int kPayloadCells = 6;
  const int gap = static_cast<int>(std::lround(grid.tag_spacing_ratio * kTagCells));
  const int pitch = kTagCells + gap;
  const int cols = grid.tag_cols * pitch - gap + 2 * kMarginCells;
  const int rows = grid.tag_rows * pitch - gap + 2 * kMarginCells;
  cv::Mat cells(rows, cols, CV_8UC1, cv::Scalar(230));
  const auto fill = [&](int col, int row, int size, int value) {  // row counts up from the board's bottom edge
    const cv::Rect square(kMarginCells + col, rows - kMarginCells - row - size, size, size);
    cells(square & cv::Rect(0, 0, cols, rows)) = value;
  };
  const target::TagFamily family = target::tagFamily(grid.family);
  for (int index = 0; index < target::numTags(grid); ++index) {
    const int col = index % grid.tag_cols * pitch;
    const int row = index / grid.tag_cols * pitch;
    fill(col, row, kTagCells, 25);
    for (int k = 0; k < kPayloadCells * kPayloadCells; ++k) {
      if (target::isWhiteCell(family, grid.code_offset + index, k / kPayloadCells, k % kPayloadCells)) {
        fill(col + 2 + k % kPayloadCells, row + kTagCells - 3 - k / kPayloadCells, 1, 230);
      }
    }
  }
  for (int i = 0; i <= grid.tag_rows; ++i) {
    for (int j = 0; j <= grid.tag_cols; ++j) {
      fill(j * pitch - gap, i * pitch - gap, gap, 25);
    }
  }
  cv::Mat sheet;
  cv::resize(cells, sheet, cv::Size(), kPixelsPerCell, kPixelsPerCell, cv::INTER_NEAREST);
  return sheet;
}

inline cv::Mat drawBoard(const target::AprilGrid& grid, const Pinhole& pinhole, const geometry::Rigid3& T_cam_target) {
  const cv::Mat sheet = drawSheet(grid);
  const double cell_m = grid.tag_size_m / 10.0;
  const double pixel_m = cell_m / kPixelsPerCell;
  const double margin_px = kMarginCells * kPixelsPerCell;
  Eigen::Matrix3d sheet_to_board;                               // pixel centre to metres, y up
  sheet_to_board << pixel_m, 0.0, (0.5 - margin_px) * pixel_m,  //
      0.0, -pixel_m, (sheet.rows - margin_px - 0.5) * pixel_m,  //
      0.0, 0.0, 1.0;
  Eigen::Matrix3d board_to_camera;
  const Eigen::Matrix3d R = T_cam_target.rotation.toRotationMatrix();
  board_to_camera << R.col(0), R.col(1), T_cam_target.translation;
  Eigen::Matrix3d K;
  K << pinhole.focal_px, 0.0, 0.5 * (pinhole.width - 1), 0.0, pinhole.focal_px, 0.5 * (pinhole.height - 1), 0.0, 0.0, 1.0;
  const Eigen::Matrix3d H = K * board_to_camera * sheet_to_board;
  cv::Mat homography(3, 3, CV_64F);
  for (int row = 0; row < 3; ++row) {
    for (int col = 0; col < 3; ++col) {
      homography.at<double>(row, col) = H(row, col);
    }
  }
  cv::Mat image;
  cv::warpPerspective(sheet, image, homography, {pinhole.width, pinhole.height}, cv::INTER_LINEAR, cv::BORDER_CONSTANT,
                      cv::Scalar(128));
  cv::GaussianBlur(image, image, {5, 5}, 0.8);
  return image;
}

/// A board in the middle of the image, facing the camera but for a tilt that depends on `index`.
inline geometry::Rigid3 boardPose(const target::AprilGrid& grid, int index) {
  const std::vector<Eigen::Vector3d> points = target::cornerPoints(grid);
  const Eigen::Vector3d centre = 0.5 * (points.front() + points.back());
  const Eigen::Vector3d tilt(0.5 * std::sin(2.1 * index), 0.5 * std::cos(1.3 * index), 0.3 * std::sin(0.7 * index));
  const Eigen::Quaterniond R = geometry::expRotation(tilt) * geometry::expRotation({M_PI, 0.0, 0.0});
  const Eigen::Vector3d place(0.08 * std::sin(1.7 * index), 0.06 * std::cos(2.3 * index), 0.75);
  return geometry::Rigid3(R, place - R * centre);
}

}  // namespace tartan_calib::pipeline
