#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "tartan_calib/target/target.h"

namespace tartan_calib::apps {

struct BlackRectangle {
  Eigen::Vector2d corner_mm;  ///< upper left
  Eigen::Vector2d size_mm;
};

struct BlackDisc {
  Eigen::Vector2d centre_mm;
  double radius_mm = 0.0;
};

/// What is printed of a board, without paper around it: millimetres to the right and down from its upper left corner.
/// AprilGrids stand as Kalibr prints them, the first tag at the lower left; the columns of other boards run to the right and
/// their rows down.
struct Artwork {
  Eigen::Vector2d size_mm = Eigen::Vector2d::Zero();
  std::vector<BlackRectangle> rectangles;  ///< may touch, do not overlap
  std::vector<BlackDisc> discs;
  std::string caption;  ///< the board in words
};

/// Throws InputError for an AprilGrid that has more tags than its family.
Artwork makeArtwork(const target::Target& target);

}  // namespace tartan_calib::apps
