#pragma once

#include <Eigen/Core>

namespace tartan_calib::detection {

/// Cubic B-spline: weights of the values at -1, 0, 1 and 2 for a sample at t in [0, 1).
inline Eigen::Array4f splineWeights(float t) {
  const Eigen::Array4f c0(1.0F / 6.0F, 4.0F / 6.0F, 1.0F / 6.0F, 0.0F);
  const Eigen::Array4f c1(-0.5F, 0.0F, 0.5F, 0.0F);
  const Eigen::Array4f c2(0.5F, -1.0F, 0.5F, 0.0F);
  const Eigen::Array4f c3(-1.0F / 6.0F, 0.5F, -0.5F, 1.0F / 6.0F);
  return c0 + t * (c1 + t * (c2 + t * c3));
}

/// Their derivatives.
inline Eigen::Array4f splineSlopes(float t) {
  const Eigen::Array4f c1(-0.5F, 0.0F, 0.5F, 0.0F);
  const Eigen::Array4f c2(1.0F, -2.0F, 1.0F, 0.0F);
  const Eigen::Array4f c3(-0.5F, 1.5F, -1.5F, 0.5F);
  return c1 + t * (c2 + t * c3);
}

}  // namespace tartan_calib::detection
