#pragma once

#include <opencv2/core.hpp>
#include <string>

#include "tartan_calib/calibration/validate.h"

namespace tartan_calib::guidance {

struct ErrorOverlay {
  const calibration::ImageErrors* errors = nullptr;  ///< may be absent: the board was not seen
  double magnification = 50.0;                       ///< of the errors, which are drawn as lines from the measured corner
  double full_scale_px = 1.0;                        ///< error with the brightest colour
  std::string headline;                              ///< ASCII, below the picture
  std::string status;                                ///< below it, small
};

/// The image with the reprojection errors of its corners, CV_8UC3, scaled down to at most `max_width`, and lines of text
/// below. Corners that were detected wrongly are crossed out.
cv::Mat drawErrors(const cv::Mat& gray, const ErrorOverlay& overlay, int max_width);

}  // namespace tartan_calib::guidance
