#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>

namespace tartan_calib::simulation {

/// Sums weight * (area of the pixel inside of the polygon) for every pixel, exactly: no samples are taken.
///
/// Polygons are given edge by edge in any order, counter-clockwise as seen on the screen; (0, 0) is the centre of the first
/// pixel. An edge adds `weight * height` to everything on its right, so the covered area of a row is a running sum over what
/// the edges leave in the few pixels that they cross. The derivative of a pixel's area by a shift of the shape is the edge
/// within the pixel turned by 90 degrees (Gauss' theorem), and comes for free.
class CoverageBuffer {
 public:
  /// `window`: the pixels to compute; edges may lie anywhere.
  explicit CoverageBuffer(const cv::Rect& window);

  void addEdge(const Eigen::Vector2d& from_px, const Eigen::Vector2d& to_px, double weight);

  /// CV_32FC1 of the window's size.
  cv::Mat1f coverage() const;

  /// d(coverage) / d(shift of all polygons [px]), CV_32FC2 of the window's size.
  const cv::Mat2f& shiftDerivative() const { return shift_derivative_; }

 private:
  struct RowPiece {
    int row;
    double x_from;
    double x_to;
    double signed_height;  ///< times weight, positive downwards
    double signed_width;   ///< times weight, positive to the right
  };

  void addLeftOf(double y_from, double y_to, double weight);
  void addInsideColumns(const Eigen::Vector2d& from, const Eigen::Vector2d& to, double weight);
  void addRowPiece(const RowPiece& piece);

  cv::Point2d origin_;       ///< outer corner of the window's first pixel
  cv::Mat1f column_change_;  ///< one spare column on the right
  cv::Mat2f shift_derivative_;
};

}  // namespace tartan_calib::simulation
