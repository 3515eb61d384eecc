#pragma once

#include <opencv2/core.hpp>
#include <optional>

namespace tartan_calib::apps {

struct ImageQuality {
  double mean_level = 0.0;    ///< of 255
  double bright_level = 0.0;  ///< 1 % of the pixels are brighter
  double saturated_ratio = 0.0;
  double black_ratio = 0.0;
  /// Black to white over so many pixels (contrast / slope at the steepest point), median over the edges; of the two main
  /// directions of edges that in which they are wider, so that motion in one direction shows. Empty without strong edges.
  std::optional<double> edge_width_px;
};

/// `gray`: CV_8UC1.
ImageQuality qualityOf(const cv::Mat& gray);

}  // namespace tartan_calib::apps
