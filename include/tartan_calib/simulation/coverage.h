#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>

namespace tartan_calib::simulation {

/// Sums weight * (area of the pixel inside of the polygon) for every pixel, exactly: no samples are taken.
///
/// Polygons are given edge by edge in any order, counter-clockwise as seen on the screen; (0, 0) is the centre of the first
/// pixel. An edge adds `weight * height` to everything on its right, so the covered area of a row is a running sum over what
/// the edges leave in the few pixels that they cross.
class CoverageBuffer {
 public:
  /// `window`: the pixels to compute; edges may lie anywhere.
  explicit CoverageBuffer(const cv::Rect& window);

  void addEdge(const Eigen::Vector2d& from_px, const Eigen::Vector2d& to_px, double weight);

  /// CV_32FC1 of the window's size.
  cv::Mat1f coverage() const;

 private:
  void addInsideColumns(const Eigen::Vector2d& from, const Eigen::Vector2d& to, double weight);
  void addRowPiece(int row, double x_from, double x_to, double signed_height);

  cv::Point2d origin_;       ///< outer corner of the window's first pixel
  cv::Mat1f column_change_;  ///< one spare column on the right
};

}  // namespace tartan_calib::simulation
