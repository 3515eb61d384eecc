#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <vector>

#include "tartan_calib/detection/board_map.h"
#include "tartan_calib/target/tag_family.h"
#include "tartan_calib/target/target.h"

namespace tartan_calib::detection {

/// Compares the payloads of an AprilGrid's tags with an image.
class TagPayload {
 public:
  explicit TagPayload(const target::AprilGrid& grid);

  /// Pearson's correlation of the cells of one tag, sampled through the map at `shift_px` beside it, with its code.
  double correlation(const cv::Mat& gray, const BoardMap& map, int tag_index, const Eigen::Vector2d& shift_px) const;

 private:
  target::AprilGrid grid_;
  const target::TagFamily& family_;
  std::vector<Eigen::Vector3d> corner_points_;
};

}  // namespace tartan_calib::detection
