#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "tartan_calib/observation/observation.h"

namespace tartan_calib::guidance {

/// A part of the image: column and row of a 3x3 grid, from the upper left.
struct Region {
  int col = 1;
  int row = 1;

  bool operator==(const Region& other) const { return col == other.col && row == other.row; }
};

constexpr int kRegionsPerSide = 3;

/// Where a pixel lies; pixels outside of the image belong to the nearest region.
Region regionOf(const Eigen::Vector2d& px, int width, int height);

/// `upper left corner`, `left side`, `centre`, ...
std::string regionName(const Region& region);

/// Where the board faces besides the camera, as one sees it in the image.
enum class Tilt { kNone, kLeft, kRight, kUp, kDown };

constexpr int kNumTilts = 5;

/// Of a direction in the image (y down), for a board turned by that angle from facing the camera.
Tilt tiltOf(const Eigen::Vector2d& direction, double angle_rad);

/// What can be said about a board in the image without knowing the camera.
struct BoardShape {
  Eigen::Vector2d centre_px = Eigen::Vector2d::Zero();
  double size_px = 0.0;  ///< geometric mean of the board's extents, seen or not
  Tilt tilt = Tilt::kNone;
};

/// From an affine map of the board to the image and how its scale changes over the board. Empty below 6 corners and where
/// they lie on a line.
std::optional<BoardShape> boardShape(const std::vector<observation::Corner>& corners,
                                     const std::vector<Eigen::Vector3d>& target_points);

}  // namespace tartan_calib::guidance
