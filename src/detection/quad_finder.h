#pragma once

#include <Eigen/Core>
#include <array>
#include <opencv2/core.hpp>
#include <vector>

namespace tartan_calib::detection {

/// Corners of a dark quadrilateral [px], one after the other round it, either way.
using Quad = std::array<Eigen::Vector2d, 4>;

/// Dark quadrilaterals with straight sides on lighter ground: tags, decodable or not, and whatever else looks like one. The
/// image is thresholded against the means of windows of several sizes; small bridges at the corners, as between the tags and
/// the corner squares of an AprilGrid, are cut. A quadrilateral may be found more than once. `gray`: CV_8UC1.
std::vector<Quad> findQuads(const cv::Mat& gray);

}  // namespace tartan_calib::detection
