#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <optional>
#include <vector>

#include "tartan_calib/detection/board_map.h"

namespace tartan_calib::detection {

/// What an X-corner should look like in one image: sample positions around it, through lens and pose, and the expected
/// pattern.
struct XCornerTemplate {
  Eigen::Vector2d px = Eigen::Vector2d::Zero();  ///< predicted position
  std::vector<Eigen::Vector2d> offsets_px;       ///< of the samples from the corner
  std::vector<double> pattern;                   ///< -1 dark ... +1 light, soft at the edges, mean 0
};

/// How the image agrees with a template.
struct XCornerMatch {
  Eigen::Vector2d px = Eigen::Vector2d::Zero();
  double correlation = 0.0;  ///< of grey values and pattern, -1 ... 1
  double contrast = 0.0;     ///< light minus dark [grey levels]
};

/// Samples the square of `half_width_m` around the corner. `dark_diagonal` as target::darkDiagonal, not 0. Empty where the
/// map does not reach the whole square.
std::optional<XCornerTemplate> xCornerTemplate(const BoardMap& map, const Eigen::Vector2d& corner_m, double half_width_m,
                                               int dark_diagonal);

/// The same corner, looked at within half the width.
XCornerTemplate innerTemplate(const XCornerTemplate& corner);

/// Compares at one position, with the samples inside of the image. Empty where they are too few.
std::optional<XCornerMatch> matchXCorner(const cv::Mat& gray, const XCornerTemplate& corner, const Eigen::Vector2d& px);

/// The position of best correlation within `radius_px` of the prediction, to half a pixel.
std::optional<XCornerMatch> searchXCorner(const cv::Mat& gray, const XCornerTemplate& corner, double radius_px);

}  // namespace tartan_calib::detection
