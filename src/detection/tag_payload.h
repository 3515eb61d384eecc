#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <optional>
#include <vector>

#include "payload_patterns.h"
#include "tartan_calib/detection/board_map.h"
#include "tartan_calib/target/tag_family.h"
#include "tartan_calib/target/target.h"

namespace tartan_calib::detection {

/// What is seen where the payload of a tag should be.
enum class PayloadVerdict {
  kThisTag,
  kOtherTag,  ///< another one of the family, or this one turned
  kUnclear,   ///< hidden, cut by the border of the image, or too blurred to tell
};

/// Compares the payloads of an AprilGrid's tags with an image.
class TagPayload {
 public:
  explicit TagPayload(const target::AprilGrid& grid);

  /// Looks at the cells of one tag, sampled through the map at `shift_px` beside it.
  PayloadVerdict verdict(const cv::Mat& gray, const BoardMap& map, int tag_index, const Eigen::Vector2d& shift_px) const;

 private:
  using Cells = std::vector<std::optional<float>>;  ///< grey values row by row; empty outside of the image

  Cells sample(const cv::Mat& gray, const BoardMap& map, int tag_index, const Eigen::Vector2d& shift_px) const;
  double correlation(const Cells& cells, int tag_id) const;
  bool showsOtherTag(const Cells& cells, int tag_id) const;

  target::AprilGrid grid_;
  const target::TagFamily& family_;
  PayloadPatterns family_patterns_;  ///< by tag id
  std::vector<Eigen::Vector3d> corner_points_;
};

}  // namespace tartan_calib::detection
