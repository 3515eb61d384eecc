#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

namespace tartan_calib::detection {

/// A point of the plane of a tag and where it is seen.
struct TagPoint {
  Eigen::Vector2d uv;  ///< [tag sides]
  Eigen::Vector2d px;
};

/// Where the points of a tag's plane are seen: the homography of its four corners, plus a bend that leaves the corners in
/// place, estimated from points around the tag. uv = (0, 0), (1, 0), (1, 1), (0, 1) are the corners, clockwise on the
/// screen.
class TagMap {
 public:
  explicit TagMap(const std::array<Eigen::Vector2d, 4>& corners_px);

  /// Bends the map towards points outside of the tag. Without any it stays a homography.
  void bendTowards(const std::vector<TagPoint>& points);

  Eigen::Vector2d operator()(const Eigen::Vector2d& uv) const;

 private:
  using Bend = Eigen::Matrix<double, 4, 2>;

  Eigen::Vector2d flat(const Eigen::Vector2d& uv) const;

  Eigen::Matrix<double, 2, 3> numerator_;
  Eigen::Vector2d denominator_;  ///< beside the constant 1
  Bend bend_px_ = Bend::Zero();
};

}  // namespace tartan_calib::detection
