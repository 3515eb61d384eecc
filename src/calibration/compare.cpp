#include "tartan_calib/calibration/compare.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <string>

#include "tartan_calib/error.h"
#include "tartan_calib/geometry/rigid3.h"

namespace tartan_calib::calibration {
namespace {

constexpr int kMinSamples = 3;
constexpr int kMaxSteps = 50;
constexpr double kConverged_rad = 1e-12;

struct RaySample {
  Eigen::Vector2d px_a;
  Eigen::Vector3d ray_a;
};

std::vector<RaySample> raysOf(const camera::CameraModel& a, const std::vector<Eigen::Vector2d>& samples_px) {
  std::vector<RaySample> rays;
  for (const Eigen::Vector2d& px : samples_px) {
    if (const auto ray = camera::unproject(a, px)) {
      rays.push_back({px, *ray});
    }
  }
  return rays;
}

/// One Gauss-Newton step for the rotation, phi in R <- exp(phi) R. Rays that b cannot project take no part.
template <class Model>
Eigen::Vector3d rotationStep(const Model& b, const std::vector<RaySample>& rays, const Eigen::Quaterniond& R_b_a) {
  Eigen::Matrix3d H = Eigen::Matrix3d::Zero();
  Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
  for (const RaySample& sample : rays) {
    const Eigen::Vector3d ray_b = R_b_a * sample.ray_a;
    Eigen::Vector2d px_b;
    camera::Matrix23d J_px_ray;
    if (!b.project(ray_b, px_b, &J_px_ray)) {
      continue;
    }
    const camera::Matrix23d J_px_phi = -J_px_ray * geometry::hat(ray_b);
    H += J_px_phi.transpose() * J_px_phi;
    gradient += J_px_phi.transpose() * (px_b - sample.px_a);
  }
  return -H.ldlt().solve(gradient);
}

}  // namespace

ProjectionDifference compareProjections(const camera::CameraModel& a, const camera::CameraModel& b,
                                        const std::vector<Eigen::Vector2d>& samples_px) {
  const std::vector<RaySample> rays = raysOf(a, samples_px);
  ProjectionDifference result;
  for (int step = 0; step < kMaxSteps && !rays.empty(); ++step) {
    const Eigen::Vector3d phi = std::visit([&](const auto& model) { return rotationStep(model, rays, result.R_b_a); }, b);
    if (!phi.allFinite()) {
      break;
    }
    result.R_b_a = (geometry::expRotation(phi) * result.R_b_a).normalized();
    if (phi.norm() < kConverged_rad) {
      break;
    }
  }
  double sum_px2 = 0.0;
  for (const RaySample& sample : rays) {
    if (const auto px_b = camera::project(b, result.R_b_a * sample.ray_a)) {
      const Eigen::Vector2d difference_px = *px_b - sample.px_a;
      result.pixels.push_back({sample.px_a, difference_px});
      result.max_px = std::max(result.max_px, difference_px.norm());
      sum_px2 += difference_px.squaredNorm();
    }
  }
  if (result.pixels.size() < kMinSamples) {
    throw CalibrationError("cannot compare the two calibrations: only " + std::to_string(result.pixels.size()) +
                           " of the sampled pixels have a ray in both");
  }
  result.rms_px = std::sqrt(sum_px2 / static_cast<double>(result.pixels.size()));
  return result;
}

std::vector<Eigen::Vector2d> imageGrid(int width, int height, double spacing_px) {
  const auto offsets = [spacing_px](int size) {
    const int count = std::max(1, static_cast<int>(std::floor((size - 1) / spacing_px)) + 1);
    const double first = 0.5 * (size - 1 - (count - 1) * spacing_px);
    std::vector<double> values;
    for (int i = 0; i < count; ++i) {
      values.push_back(first + i * spacing_px);
    }
    return values;
  };
  std::vector<Eigen::Vector2d> grid;
  for (const double v : offsets(height)) {
    for (const double u : offsets(width)) {
      grid.emplace_back(u, v);
    }
  }
  return grid;
}

}  // namespace tartan_calib::calibration
