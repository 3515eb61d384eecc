#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

namespace tartan_calib::apps {

struct CloudPoint {
  Eigen::Vector3d p_cam = Eigen::Vector3d::Zero();
  cv::Scalar colour;  ///< blue, green, red
};

/// Points around a camera, seen at an angle, from above and from the right of the camera, side by side and to one scale.
/// `unit` is written beside the length of the camera's axes.
cv::Mat drawPointCloud(const std::vector<CloudPoint>& points, const std::string& unit);

/// Colour of the `index`-th of `count`, from blue to red.
cv::Scalar sequenceColour(std::size_t index, std::size_t count);

}  // namespace tartan_calib::apps
