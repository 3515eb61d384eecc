#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "tartan_calib/guidance/coverage_map.h"
#include "tartan_calib/observation/observation.h"

namespace tartan_calib::guidance {

/// What is drawn over an image.
struct Overlay {
  const CoverageMap* coverage = nullptr;              ///< as a heat map; may be absent
  std::vector<observation::Corner> corners;           ///< seen now
  std::vector<std::vector<Eigen::Vector2d>> outline;  ///< where to hold the board: lines [px]
  std::string warning;                                ///< over the picture's upper edge, may be empty
  std::string advice;                                 ///< below the picture, in large letters; ASCII
  std::string status;                                 ///< below it, small
};

/// The image with its overlay, CV_8UC3, scaled down to at most `max_width`, and lines of text below. Colours are told apart
/// by people with any kind of colour vision: the heat map (cividis) also differs in brightness, lines have a dark edge.
cv::Mat drawOverlay(const cv::Mat& gray, const Overlay& overlay, int max_width);

}  // namespace tartan_calib::guidance
