#include "tartan_calib/geometry/averaging.h"

#include <algorithm>

#include "tartan_calib/error.h"

namespace tartan_calib::geometry {
namespace {

constexpr int kMaxWeiszfeldSteps = 200;
constexpr double kConverged = 1e-12;
/// An input closer than this to the iterate would get infinite weight.
constexpr double kMinDistance = 1e-12;

/// The input with the smallest sum of distances to all others: a start from which Weiszfeld converges.
template <typename T, typename Distance>
std::size_t medoid(const std::vector<T>& values, const Distance& distance) {
  std::size_t best = 0;
  double best_sum = -1.0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    double sum = 0.0;
    for (const T& other : values) {
      sum += distance(values[i], other);
    }
    if (best_sum < 0.0 || sum < best_sum) {
      best_sum = sum;
      best = i;
    }
  }
  return best;
}

}  // namespace

Eigen::Quaterniond medianRotation(const std::vector<Eigen::Quaterniond>& rotations) {
  if (rotations.empty()) {
    throw Error("medianRotation needs at least one rotation");
  }
  const auto angle = [](const Eigen::Quaterniond& a, const Eigen::Quaterniond& b) { return a.angularDistance(b); };
  Eigen::Quaterniond median = rotations[medoid(rotations, angle)];
  for (int step = 0; step < kMaxWeiszfeldSteps; ++step) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    double weights = 0.0;
    for (const Eigen::Quaterniond& R : rotations) {
      const Eigen::Vector3d phi = logRotation(R * median.conjugate());
      const double weight = 1.0 / std::max(phi.norm(), kMinDistance);
      sum += weight * phi;
      weights += weight;
    }
    const Eigen::Vector3d delta = sum / weights;
    median = (expRotation(delta) * median).normalized();
    if (delta.norm() < kConverged) {
      break;
    }
  }
  return median;
}

Eigen::Vector3d medianPoint(const std::vector<Eigen::Vector3d>& points) {
  if (points.empty()) {
    throw Error("medianPoint needs at least one point");
  }
  const auto distance = [](const Eigen::Vector3d& a, const Eigen::Vector3d& b) { return (a - b).norm(); };
  Eigen::Vector3d median = points[medoid(points, distance)];
  for (int step = 0; step < kMaxWeiszfeldSteps; ++step) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    double weights = 0.0;
    for (const Eigen::Vector3d& p : points) {
      const double weight = 1.0 / std::max((p - median).norm(), kMinDistance);
      sum += weight * p;
      weights += weight;
    }
    const Eigen::Vector3d next = sum / weights;
    const double moved = (next - median).norm();
    median = next;
    if (moved < kConverged) {
      break;
    }
  }
  return median;
}

Rigid3 medianRigid(const std::vector<Rigid3>& transforms) {
  std::vector<Eigen::Quaterniond> rotations;
  std::vector<Eigen::Vector3d> translations;
  for (const Rigid3& T : transforms) {
    rotations.push_back(T.rotation);
    translations.push_back(T.translation);
  }
  return Rigid3(medianRotation(rotations), medianPoint(translations));
}

}  // namespace tartan_calib::geometry
