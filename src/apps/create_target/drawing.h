#pragma once

#include <opencv2/core.hpp>
#include <string>

#include "create_target/sheet.h"

namespace tartan_calib::apps {

/// One page of vectors at true scale; the same bytes for the same sheet.
std::string pdfOf(const Sheet& sheet);

/// CV_8UC1 of `pixels_per_mm`; pixel (u, v) shows the millimetres [u, u + 1) x [v, v + 1) / pixels_per_mm. Throws
/// InputError where that is more than an image may have.
cv::Mat imageOf(const Sheet& sheet, double pixels_per_mm);

/// A PNG file that knows its scale, so that it prints at its size.
std::string pngOf(const cv::Mat& gray, double pixels_per_mm);

}  // namespace tartan_calib::apps
