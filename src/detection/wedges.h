#pragma once

#include <Eigen/Core>
#include <array>
#include <opencv2/core.hpp>
#include <optional>

namespace tartan_calib::detection {

/// The two dark and two light wedges around an X-junction.
struct Wedges {
  std::array<double, 4> arm_rad;  ///< as Saddle::arm_rad
  double contrast;                ///< light minus dark [grey levels]
};

/// Reads the wedges from rings around a pixel; nothing where there are not two dark and two light ones, opposite each other
/// and alike.
std::optional<Wedges> findWedges(const cv::Mat& gray, const Eigen::Vector2d& px);

}  // namespace tartan_calib::detection
