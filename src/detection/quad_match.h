#pragma once

#include <Eigen/Core>
#include <map>
#include <optional>
#include <vector>

#include "quad_finder.h"
#include "tartan_calib/target/target.h"

namespace tartan_calib::detection {

/// Corner id to where a quadrilateral has it [px].
using QuadCorners = std::map<int, Eigen::Vector2d>;

/// The filter of Duisterhof et al. 2022: keeps the quadrilaterals that lie on one predicted tag, each corner within
/// `max_distance_px` of the tag's and in its order, and names their corners; of several on one tag the closest.
/// `predicted_px`: by corner id; empty where the image does not show the corner.
QuadCorners matchQuads(const std::vector<Quad>& quads, const target::AprilGrid& grid,
                       const std::vector<std::optional<Eigen::Vector2d>>& predicted_px, double max_distance_px);

}  // namespace tartan_calib::detection
