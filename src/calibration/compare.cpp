#include "tartan_calib/calibration/compare.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "tartan_calib/error.h"
#include "tartan_calib/geometry/linear_solve.h"

namespace tartan_calib::calibration {
namespace {

constexpr int kMinSamples = 3;
constexpr int kMaxSteps = 50;
constexpr double kConverged = 1e-12;  ///< of a step [rad, m]

struct PointSample {
  Eigen::Vector2d px_a;
  Eigen::Vector3d p_a;
};

/// Points that a sees at the pixels, all at the same distance.
std::vector<PointSample> pointsOf(const camera::CameraModel& a, const std::vector<Eigen::Vector2d>& samples_px,
                                  double distance_m) {
  std::vector<PointSample> points;
  for (const Eigen::Vector2d& px : samples_px) {
    if (const auto ray = camera::unproject(a, px)) {
      points.push_back({px, distance_m * *ray});
    }
  }
  return points;
}

/// One Gauss-Newton step, xi in T <- exp(xi) T; without `moves` its translation stays zero. Points that b cannot project
/// take no part.
geometry::Vector6d motionStep(const camera::CameraModel& b, const std::vector<PointSample>& points,
                              const geometry::Rigid3& T_b_a, bool moves) {
  geometry::Matrix6d H = geometry::Matrix6d::Zero();
  geometry::Vector6d gradient = geometry::Vector6d::Zero();
  for (const PointSample& sample : points) {
    const Eigen::Vector3d p_b = T_b_a * sample.p_a;
    camera::Matrix23d J_px_p;
    const auto px_b = camera::project(b, p_b, &J_px_p);
    if (!px_b) {
      continue;
    }
    Eigen::Matrix<double, 2, 6> J_px_xi;
    J_px_xi << J_px_p, -J_px_p * geometry::hat(p_b);
    H += J_px_xi.transpose() * J_px_xi;
    gradient += J_px_xi.transpose() * (*px_b - sample.px_a);
  }
  if (!moves) {
    H.topRows<3>().setIdentity();
    H.bottomLeftCorner<3, 3>().setZero();
    gradient.head<3>().setZero();
  }
  return -geometry::solveTwist(H, gradient);
}

}  // namespace

ProjectionDifference compareProjections(const camera::CameraModel& a, const camera::CameraModel& b,
                                        const std::vector<Eigen::Vector2d>& samples_px, std::optional<double> distance_m) {
  const std::vector<PointSample> points = pointsOf(a, samples_px, distance_m.value_or(1.0));
  ProjectionDifference result;
  for (int step = 0; step < kMaxSteps && !points.empty(); ++step) {
    const geometry::Vector6d xi = motionStep(b, points, result.T_b_a, distance_m.has_value());
    if (!xi.allFinite()) {
      break;
    }
    result.T_b_a = geometry::expRigid(xi) * result.T_b_a;
    if (xi.norm() < kConverged) {
      break;
    }
  }
  double sum_px2 = 0.0;
  for (const PointSample& sample : points) {
    if (const auto px_b = camera::project(b, result.T_b_a * sample.p_a)) {
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
