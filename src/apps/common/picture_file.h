#pragma once

#include <opencv2/core.hpp>
#include <string>
#include <vector>

namespace tartan_calib::apps {

/// Drawings side by side, two in a row.
cv::Mat arrange(const std::vector<cv::Mat>& pictures);

/// Whole or not at all; Ctrl-C waits for it. Throws InputError where `path` does not end in .png or cannot be written.
void savePng(const std::string& path, const cv::Mat& picture);

/// Throws InputError for a path that savePng would refuse by its name.
void checkPngName(const std::string& path);

}  // namespace tartan_calib::apps
