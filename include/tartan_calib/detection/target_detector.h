#pragma once

#include <map>
#include <memory>
#include <opencv2/core.hpp>
#include <string>
#include <utility>
#include <vector>

#include "tartan_calib/observation/observation.h"
#include "tartan_calib/target/target.h"

namespace tartan_calib::detection {

/// Filters with Kalibr's defaults.
struct DetectorOptions {
  double min_border_distance_px = 4.0;  ///< a tag with a corner closer to the edge of the image, at -0.5, is dropped
  int max_hamming = 1;                  ///< bit errors that a tag's payload may have
  double max_refine_shift_px = 1.2247448713915890;  ///< a corner that refinement moves further is dropped (sqrt 1.5)
};

/// Inner corners of a checkerboard, the fewer ones first, since nothing tells rows from columns; rows and columns of tags.
using BoardSize = std::pair<int, int>;

/// What was seen besides the corners; counts are tags, except where they say otherwise.
struct DetectionCounts {
  int tags = 0;                          ///< decoded, placed on the board and kept
  int duplicate_tags = 0;                ///< an id seen more than once: every copy is dropped
  int foreign_tags = 0;                  ///< ids that the board does not have, or that contradict the lattice
  int mirrored_tags = 0;                 ///< decode only when mirrored
  int other_border_tags = 0;             ///< would decode with the other border width (1 instead of 2 cells or the reverse)
  std::map<BoardSize, int> other_sizes;  ///< images with a board of the target's kind, but of another size

  DetectionCounts& operator+=(const DetectionCounts& more);
};

struct Detection {
  std::vector<observation::Corner> corners;  ///< by increasing corner_id, refined to sub-pixel
  DetectionCounts counts;
};

class DetectionMethod;

/// Finds the corners of one target in images. `detect` is const and may be called from several threads.
class TargetDetector {
 public:
  explicit TargetDetector(const target::Target& target, const DetectorOptions& options = {});
  ~TargetDetector();
  TargetDetector(TargetDetector&&) noexcept;
  TargetDetector& operator=(TargetDetector&&) noexcept;

  /// `gray`: CV_8UC1. An image without the target gives an empty Detection.
  Detection detect(const cv::Mat& gray) const;

 private:
  std::unique_ptr<const DetectionMethod> method_;
};

}  // namespace tartan_calib::detection
