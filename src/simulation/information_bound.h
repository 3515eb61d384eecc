#pragma once

#include <Eigen/Core>

#include "exposure.h"
#include "tartan_calib/simulation/scene.h"
#include "tartan_calib/simulation/true_corner.h"

namespace tartan_calib::simulation {

/// Cramer-Rao bounds of the corners of one picture. With pixels I_p = light_p + noise of variance var_p,
///   cov >= ( sum_p J_p J_p^T / var_p )^-1,   J_p = d(light_p) / d(corner),
/// over the pixels that show this corner and nothing else (cornerHalfWindow). Saturated pixels tell nothing.
class InformationBound {
 public:
  /// Keeps references.
  InformationBound(const Exposure& exposure, const Scene& scene, const camera::Camera& camera,
                   const geometry::Rigid3& T_cam_target);

  /// At most kNoInformationPx2.
  Eigen::Matrix2d ofCorner(const TrueCorner& corner) const;

 private:
  Eigen::Matrix2d information(const Eigen::Vector2d& corner_px, const Eigen::Matrix2d& J_px_window) const;

  const Exposure& exposure_;
  const Scene& scene_;
  const camera::Camera& camera_;
  const geometry::Rigid3& T_cam_target_;
  std::vector<Eigen::Vector3d> corner_points_;
  double half_window_m_;
};

}  // namespace tartan_calib::simulation
