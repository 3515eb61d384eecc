#pragma once

#include <cstddef>
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

  /// T_rig_target of a view whose images took part in one view of the solution, which used as many corners as half of those
  /// that they have by now.
  std::optional<geometry::Rigid3> explained(const observation::View& view) const;

  /// T_cam_target of any image: from a view of the same time (other cameras of the rig), or between the views before and
  /// after. Empty where the nearest views are too far in time.
  std::optional<geometry::Rigid3> guessed(int camera_index, std::int64_t stamp_ns) const;

 private:
  geometry::Rigid3 inCamera(int camera_index, const geometry::Rigid3& T_rig_target) const;

  const calibration::Solution& solution_;
  std::int64_t sync_ns_;
  struct SolvedImage {
    std::size_t view = 0;
    std::ptrdiff_t num_used = 0;  ///< corners
  };
  std::map<std::pair<int, std::int64_t>, SolvedImage> images_;
  std::map<std::int64_t, std::size_t> view_at_;  ///< views with a pose, by stamp
};

}  // namespace tartan_calib::pipeline
