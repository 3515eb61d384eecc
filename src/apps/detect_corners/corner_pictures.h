#pragma once

#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "common/progress_bar.h"
#include "tartan_calib/observation/observation.h"
#include "tartan_calib/pipeline/camera_stream.h"
#include "tartan_calib/target/target.h"

namespace tartan_calib::apps {

/// The image in colour with a ring around every corner and, on an AprilGrid, the number of every tag. `gray`: CV_8UC1.
cv::Mat drawCorners(const cv::Mat& gray, const std::vector<observation::Corner>& corners, const target::Target& target);

/// Indices of `count` of `total` images, evenly spread; all where there are no more.
std::vector<std::size_t> evenlyChosen(std::size_t total, std::size_t count);

/// Draws at most `max_pictures` images of a topic, with or without corners, as <folder>/<stamp in ns>.png. The folder is
/// made. `images`: what was detected, by stamp. `progress` is told how many are done. Returns how many were drawn; images
/// that cannot be read are left out.
std::size_t writeCornerPictures(const pipeline::CameraStream& stream, const std::vector<observation::CameraView>& images,
                                const target::Target& target, const std::string& folder, std::size_t max_pictures,
                                const ProgressCall& progress);

}  // namespace tartan_calib::apps
