#pragma once

#include <Eigen/Core>
#include <map>
#include <optional>
#include <utility>

namespace tartan_calib::detection {

/// Integer place in a lattice of corners.
using LatticePlace = std::pair<int, int>;

/// Map from the plane of a lattice, as offset [squares] from one of its places, to pixels, to second order.
struct LatticeMap {
  Eigen::Matrix<double, 2, 6> coefficients = Eigen::Matrix<double, 2, 6>::Zero();  ///< of 1, a, b, a^2, a b, b^2

  Eigen::Vector2d centre_px() const { return coefficients.col(0); }  ///< of the place itself
  Eigen::Vector2d offset_px(const Eigen::Vector2d& offset) const;    ///< from centre_px
  Eigen::Matrix2d J_px_offset() const { return coefficients.middleCols<2>(1); }
  /// Length of the shorter side of a square at the place.
  double minSpacing_px() const { return J_px_offset().colwise().norm().minCoeff(); }
};

/// Fits the corners around `place`, but not the one at `place` unless `use_centre`. Nothing where they are too few to
/// tell where the place is.
std::optional<LatticeMap> fitLatticeMap(const std::map<LatticePlace, Eigen::Vector2d>& corners_px, const LatticePlace& place,
                                        bool use_centre);

}  // namespace tartan_calib::detection
