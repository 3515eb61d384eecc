#pragma once

#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "tartan_calib/pipeline/calibrate.h"

namespace tartan_calib::pipeline {

/// Corners that were seen once and that a later round dropped, as they neither fit nor are found again where they should be.
class RejectedCorners {
 public:
  /// After a round that turned the corners of `before` into those of `after`.
  void update(const std::vector<CameraCorners>& before, const std::vector<CameraCorners>& after);

  /// Puts them into the result's images and counts, as rejected.
  void addTo(CalibrationResult& result) const;

 private:
  using ImageKey = std::pair<int, std::int64_t>;  ///< camera and stamp [ns]

  std::map<ImageKey, std::map<int, observation::Corner>> images_;  ///< corners by id
};

}  // namespace tartan_calib::pipeline
