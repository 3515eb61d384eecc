#pragma once

#include <opencv2/core.hpp>

#include "validate_calibration/validation.h"

namespace tartan_calib::apps {

/// Errors over the image of every camera, magnified, coloured by their length; the same scales for all cameras.
cv::Mat errorPicture(const Validation& validation);

}  // namespace tartan_calib::apps
