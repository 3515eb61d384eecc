#include "lattice_map.h"

#include <Eigen/Cholesky>
#include <cmath>

namespace tartan_calib::detection {
namespace {

using Monomials = Eigen::Matrix<double, 6, 1>;

constexpr int kReach = 2;  // corners at most so many squares away take part
// Weight of a corner falls off with distance, so that terms beyond the second order matter little.
constexpr double kWeightSigma = 1.2;
// Pulls second-order terms to zero where the corners do not tell them, as along an axis with two rows only.
constexpr double kCurvatureRidge = 0.1;
constexpr double kRankRidge = 1e-9;
// Variance of the predicted position in units of a corner's variance: below 50 next to two columns, 1 / kRankRidge next to
// one.
constexpr double kMaxLeverage = 100.0;

Monomials monomials(const Eigen::Vector2d& offset) {
  const double a = offset.x();
  const double b = offset.y();
  return (Monomials() << 1.0, a, b, a * a, a * b, b * b).finished();
}

}  // namespace

Eigen::Vector2d LatticeMap::offset_px(const Eigen::Vector2d& offset) const {
  return coefficients.rightCols<5>() * monomials(offset).tail<5>();
}

std::optional<LatticeMap> fitLatticeMap(const std::map<LatticePlace, Eigen::Vector2d>& corners_px, const LatticePlace& place,
                                        bool use_centre) {
  Eigen::Matrix<double, 6, 6> normal = Eigen::Matrix<double, 6, 6>::Zero();
  Eigen::Matrix<double, 6, 2> right = Eigen::Matrix<double, 6, 2>::Zero();
  for (int i = -kReach; i <= kReach; ++i) {
    for (int j = -kReach; j <= kReach; ++j) {
      const auto corner = corners_px.find({place.first + i, place.second + j});
      if (corner == corners_px.end() || (i == 0 && j == 0 && !use_centre)) {
        continue;
      }
      const double weight = std::exp(-0.5 * (i * i + j * j) / (kWeightSigma * kWeightSigma));
      const Monomials m = monomials({i, j});
      normal += weight * m * m.transpose();
      right += weight * m * corner->second.transpose();
    }
  }
  normal.diagonal().head<3>().array() += kRankRidge;
  normal.diagonal().tail<3>().array() += kCurvatureRidge;
  const Eigen::LDLT<Eigen::Matrix<double, 6, 6>> solver(normal);
  if (solver.solve(Monomials::Unit(0))(0) > kMaxLeverage) {
    return std::nullopt;
  }
  return LatticeMap{solver.solve(right).transpose()};
}

}  // namespace tartan_calib::detection
