#include "tartan_calib/guidance/board_shape.h"

#include <Eigen/LU>
#include <Eigen/QR>
#include <Eigen/SVD>
#include <algorithm>
#include <array>
#include <cmath>

namespace tartan_calib::guidance {
namespace {

constexpr std::size_t kMinCorners = 6;  ///< that determine a quadratic map
constexpr double kMinTilt_rad = 0.35;   ///< 20 degrees: less is hardly a tilt to a hand
constexpr double kMinCondition = 1e-3;  ///< of the corners' spread over the board

int third(double px, int size) {
  return std::clamp(static_cast<int>((px + 0.5) * kRegionsPerSide / size), 0, kRegionsPerSide - 1);
}

/// px = A [x y]' + quadratic terms, x and y relative to the mean of the corners.
struct QuadraticMap {
  Eigen::Matrix2d A;
  Eigen::Matrix<double, 3, 2> quadratic;  ///< of x^2, xy, y^2
};

std::optional<QuadraticMap> quadraticMap(const std::vector<observation::Corner>& corners,
                                         const std::vector<Eigen::Vector3d>& target_points, const Eigen::Vector2d& mean_m) {
  Eigen::MatrixXd terms(corners.size(), 6);
  Eigen::MatrixXd px(corners.size(), 2);
  double extent_m = 0.0;
  for (const observation::Corner& corner : corners) {
    extent_m = std::max(extent_m, (target_points[static_cast<std::size_t>(corner.corner_id)].head<2>() - mean_m).norm());
  }
  for (Eigen::Index i = 0; i < terms.rows(); ++i) {
    const observation::Corner& corner = corners[static_cast<std::size_t>(i)];
    const Eigen::Vector2d p = (target_points[static_cast<std::size_t>(corner.corner_id)].head<2>() - mean_m) / extent_m;
    terms.row(i) << 1.0, p.x(), p.y(), p.x() * p.x(), p.x() * p.y(), p.y() * p.y();
    px.row(i) = corner.px.transpose();
  }
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(terms.rows(), terms.cols());
  qr.setThreshold(kMinCondition);
  qr.compute(terms);
  if (qr.rank() < terms.cols()) {
    return std::nullopt;
  }
  const Eigen::Matrix<double, 6, 2> solution = qr.solve(px);
  return QuadraticMap{solution.middleRows<2>(1).transpose() / extent_m, solution.bottomRows<3>() / (extent_m * extent_m)};
}

/// log of the area scale grows in this direction of the image: towards the near side of the board.
Eigen::Vector2d nearDirection(const QuadraticMap& map) {
  const Eigen::Matrix2d inverse = map.A.inverse();
  Eigen::Matrix2d J_A_x;
  J_A_x << 2.0 * map.quadratic(0, 0), map.quadratic(1, 0), 2.0 * map.quadratic(0, 1), map.quadratic(1, 1);
  Eigen::Matrix2d J_A_y;
  J_A_y << map.quadratic(1, 0), 2.0 * map.quadratic(2, 0), map.quadratic(1, 1), 2.0 * map.quadratic(2, 1);
  const Eigen::Vector2d gradient((inverse * J_A_x).trace(), (inverse * J_A_y).trace());  // d(log det A) on the board
  return inverse.transpose() * gradient;
}

Tilt tiltIn(const QuadraticMap& map) {
  const Eigen::JacobiSVD<Eigen::Matrix2d> svd(map.A, Eigen::ComputeFullU);
  const double shortening = svd.singularValues()(1) / svd.singularValues()(0);
  const Eigen::Vector2d shortened = svd.matrixU().col(1);
  const double sign = nearDirection(map).dot(shortened) > 0.0 ? -1.0 : 1.0;  // it faces away from its near side
  return tiltOf(Eigen::Vector2d(sign * shortened), std::acos(std::min(1.0, shortening)));
}

}  // namespace

Region regionOf(const Eigen::Vector2d& px, int width, int height) { return {third(px.x(), width), third(px.y(), height)}; }

std::string regionName(const Region& region) {
  static const std::array<std::array<const char*, 3>, 3> names = {{{"upper left corner", "top", "upper right corner"},
                                                                   {"left side", "centre", "right side"},
                                                                   {"lower left corner", "bottom", "lower right corner"}}};
  return names.at(static_cast<std::size_t>(region.row)).at(static_cast<std::size_t>(region.col));
}

Tilt tiltOf(const Eigen::Vector2d& direction, double angle_rad) {
  if (angle_rad < kMinTilt_rad) {
    return Tilt::kNone;
  }
  if (std::abs(direction.x()) > std::abs(direction.y())) {
    return direction.x() < 0.0 ? Tilt::kLeft : Tilt::kRight;
  }
  return direction.y() < 0.0 ? Tilt::kUp : Tilt::kDown;
}

std::optional<BoardShape> boardShape(const std::vector<observation::Corner>& corners,
                                     const std::vector<Eigen::Vector3d>& target_points) {
  if (corners.size() < kMinCorners) {
    return std::nullopt;
  }
  BoardShape shape;
  Eigen::Vector2d mean_m = Eigen::Vector2d::Zero();
  for (const observation::Corner& corner : corners) {
    mean_m += target_points[static_cast<std::size_t>(corner.corner_id)].head<2>();
    shape.centre_px += corner.px;
  }
  mean_m /= static_cast<double>(corners.size());
  shape.centre_px /= static_cast<double>(corners.size());
  const auto map = quadraticMap(corners, target_points, mean_m);
  if (!map || !(std::abs(map->A.determinant()) > 0.0)) {
    return std::nullopt;
  }
  const Eigen::Vector2d extent_m = (target_points.back() - target_points.front()).head<2>().cwiseAbs();
  shape.size_px = std::sqrt(std::abs(map->A.determinant()) * extent_m.prod());
  shape.tilt = tiltIn(*map);
  return shape;
}

}  // namespace tartan_calib::guidance
