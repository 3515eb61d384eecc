#include "tag_map.h"

#include <Eigen/Cholesky>

namespace tartan_calib::detection {
namespace {

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

/// Displacements that vanish at the four corners: the sides of the tag bow, each pair of opposite ones on its own.
Eigen::Vector4d bendBasis(const Eigen::Vector2d& uv) {
  const double bow_u = uv.x() * (1.0 - uv.x());
  const double bow_v = uv.y() * (1.0 - uv.y());
  return {bow_u, bow_u * (uv.y() - 0.5), bow_v, bow_v * (uv.x() - 0.5)};
}

}  // namespace

TagMap::TagMap(const std::array<Eigen::Vector2d, 4>& corners_px) {
  // Heckbert, Fundamentals of Texture Mapping and Image Warping (1989), section 2.2.3: unit square to quadrilateral.
  const Eigen::Vector2d excess = corners_px[0] - corners_px[1] + corners_px[2] - corners_px[3];
  const Eigen::Vector2d to_1 = corners_px[1] - corners_px[2];
  const Eigen::Vector2d to_3 = corners_px[3] - corners_px[2];
  const double area = cross(to_1, to_3);
  denominator_ = Eigen::Vector2d(cross(excess, to_3), cross(to_1, excess)) / area;
  numerator_.col(0) = corners_px[1] - corners_px[0] + denominator_.x() * corners_px[1];
  numerator_.col(1) = corners_px[3] - corners_px[0] + denominator_.y() * corners_px[3];
  numerator_.col(2) = corners_px[0];
}

Eigen::Vector2d TagMap::flat(const Eigen::Vector2d& uv) const {
  return numerator_ * Eigen::Vector3d(uv.x(), uv.y(), 1.0) / (1.0 + denominator_.dot(uv));
}

void TagMap::bendTowards(const std::vector<TagPoint>& points) {
  constexpr double kPrior = 0.02;  // keeps bends at zero that the points do not determine; the basis is about 0.3 at them
  Eigen::Matrix4d normal = kPrior * Eigen::Matrix4d::Identity();
  Bend right = Bend::Zero();
  for (const TagPoint& point : points) {
    const Eigen::Vector4d basis = bendBasis(point.uv);
    normal += basis * basis.transpose();
    right += basis * (point.px - flat(point.uv)).transpose();
  }
  bend_px_ = normal.ldlt().solve(right);
}

Eigen::Vector2d TagMap::operator()(const Eigen::Vector2d& uv) const {
  return flat(uv) + bend_px_.transpose() * bendBasis(uv);
}

}  // namespace tartan_calib::detection
