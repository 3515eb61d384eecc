#include "tartan_calib/simulation/true_corner.h"

#include <algorithm>
#include <limits>
#include <optional>

namespace tartan_calib::simulation {
namespace {

using Lattice = std::vector<std::optional<Eigen::Vector2d>>;

/// Distance to the nearest of the eight neighbours in the corner lattice, infinite where none has an image.
double neighbourDistance(const Lattice& corners, const target::Lattice& size, int corner_id) {
  const int row = corner_id / size.cols;
  const int col = corner_id % size.cols;
  double nearest_px = std::numeric_limits<double>::infinity();
  for (int r = std::max(0, row - 1); r <= std::min(size.rows - 1, row + 1); ++r) {
    for (int c = std::max(0, col - 1); c <= std::min(size.cols - 1, col + 1); ++c) {
      const int other_id = r * size.cols + c;
      const auto& other = corners[static_cast<std::size_t>(other_id)];
      if (other_id != corner_id && other) {
        nearest_px = std::min(nearest_px, (*other - *corners[static_cast<std::size_t>(corner_id)]).norm());
      }
    }
  }
  return nearest_px;
}

bool isClearOfBorder(const camera::Camera& camera, const Eigen::Vector2d& px) {
  const Eigen::Vector2d last(camera.width - 1.0, camera.height - 1.0);
  return px.minCoeff() >= kMinBorderDistancePx && (last - px).minCoeff() >= kMinBorderDistancePx;
}

}  // namespace

std::vector<TrueCorner> projectCorners(const target::Target& target, const camera::Camera& camera,
                                       const geometry::Rigid3& T_cam_target) {
  if (T_cam_target.inverse().translation.z() <= 0.0) {
    return {};
  }
  Lattice lattice;
  for (const Eigen::Vector3d& p_target : target::cornerPoints(target)) {
    lattice.push_back(camera::project(camera.model, T_cam_target * p_target));
  }
  const target::Lattice size = target::cornerLattice(target);
  std::vector<TrueCorner> corners;
  for (int id = 0; id < static_cast<int>(lattice.size()); ++id) {
    const auto& px = lattice[static_cast<std::size_t>(id)];
    if (px && camera::isInside(camera, *px)) {
      TrueCorner corner;
      corner.corner_id = id;
      corner.px = *px;
      corner.visible = isClearOfBorder(camera, *px);
      corner.neighbour_distance_px = neighbourDistance(lattice, size, id);
      corners.push_back(corner);
    }
  }
  return corners;
}

}  // namespace tartan_calib::simulation
