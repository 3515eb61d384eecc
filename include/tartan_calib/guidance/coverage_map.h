#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <vector>

#include "tartan_calib/guidance/board_shape.h"
#include "tartan_calib/observation/observation.h"

namespace tartan_calib::guidance {

/// Where an image has corners, and where it shows anything at all: a fisheye lens leaves the corners of its image black.
class CoverageMap {
 public:
  static constexpr int kCols = 24;

  CoverageMap(int width, int height);

  int width() const { return width_; }
  int height() const { return height_; }

  /// CV_8UC1 of the map's size: what is bright in any image is lit.
  void addImage(const cv::Mat& gray);

  void clearCorners() { counts_.setTo(0); }
  void addCorners(const std::vector<observation::Corner>& corners);

  /// Corners by cell, CV_32SC1.
  const cv::Mat1i& counts() const { return counts_; }

  /// Pixels outside of the image are dark.
  bool isLit(const Eigen::Vector2d& px) const;

  /// Lit regions; of them, those of which at least half of the lit cells have no corner.
  std::vector<Region> litRegions() const;
  std::vector<Region> emptyRegions() const;

 private:
  bool isLit(int row, int col) const;
  std::vector<Region> regionsWith(double min_empty_ratio) const;

  int width_;
  int height_;
  cv::Mat1i counts_;
  cv::Mat1b brightest_;
};

}  // namespace tartan_calib::guidance
