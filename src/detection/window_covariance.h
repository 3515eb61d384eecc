#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>

namespace tartan_calib::detection {

/// Covariance of the error [px^2] of a corner that cv::cornerSubPix has moved to `px` in a square window: what the noise of
/// the pixels, as the window itself shows it, does to the point that the iteration seeks, and how far from there it ended.
Eigen::Matrix2d windowCovariance(const cv::Mat& gray, const Eigen::Vector2d& px, int half_window_px);

}  // namespace tartan_calib::detection
