#pragma once

#include <Eigen/Core>
#include <optional>

#include "tartan_calib/detection/refine.h"
#include "x_corner.h"

namespace tartan_calib::detection {

/// What to look for around a predicted corner.
struct CornerSearch {
  XCornerTemplate expected;
  double radius_px = 0.0;
  double min_correlation = 0.0;
};

/// A corner of the board that should be in the image, and what was found there.
struct CornerCandidate {
  int corner_id = -1;
  int row = 0;  ///< of the corner lattice
  int col = 0;
  XCornerTemplate expected;
  double neighbour_px = 0.0;          ///< to the nearest of its neighbours on the lattice
  std::optional<XCornerMatch> match;  ///< of the image filter: set together with refined
  std::optional<RefinedCorner> refined;

  bool isFound() const { return refined.has_value(); }
  Eigen::Vector2d shift_px() const { return refined->px - expected.px; }
  void drop() {
    match.reset();
    refined.reset();
  }
};

}  // namespace tartan_calib::detection
