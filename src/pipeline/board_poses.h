#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <utility>

#include "tartan_calib/calibration/solve.h"
#include "tartan_calib/geometry/rigid3.h"

namespace tartan_calib::pipeline {

/// Where the board was when an image was taken, as far as a solution tells.
class BoardPoses {
 public:
  /// `sync_ns`: images at most so far from a view's stamp show the board where that view saw it.
  BoardPoses(const calibration::Solution& solution, std::int64_t sync_ns);

  /// T_cam_target of an image that took part in the solution.
  std::optional<geometry::Rigid3> solved(int camera_index, std::int64_t stamp_ns) const;

  /// T_cam_target of any image: from a view of the same time (other cameras of the rig), or between the views before and
  /// after. Empty where the nearest views are too far in time.
  std::optional<geometry::Rigid3> guessed(int camera_index, std::int64_t stamp_ns) const;

 private:
  geometry::Rigid3 inCamera(int camera_index, const geometry::Rigid3& T_rig_target) const;

  const calibration::Solution& solution_;
  std::int64_t sync_ns_;
  std::map<std::pair<int, std::int64_t>, std::size_t> view_of_image_;
  std::map<std::int64_t, std::size_t> view_at_;  ///< views with a pose, by stamp
};

}  // namespace tartan_calib::pipeline
