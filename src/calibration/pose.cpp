#include "tartan_calib/calibration/pose.h"

#include <Eigen/LU>
#include <array>
#include <cmath>
#include <limits>

#include "robust.h"
#include "tartan_calib/geometry/linear_solve.h"
#include "tartan_calib/median.h"
#include "tartan_calib/solver/parallel.h"

namespace tartan_calib::calibration {
namespace {

using geometry::Rigid3;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr std::size_t kSampleSize = 4;  ///< corners that determine a plane's homography
/// With 40 % wrong corners a sample is right with probability 0.13: 100 samples miss once in 10^6.
constexpr int kMaxSamples = 100;
/// Half of the corners this close: no need to look for a better start. As a share of the image's diagonal.
constexpr double kGoodStart = 5e-4;
/// A pose that is further off for half of the corners explains nothing.
constexpr double kExplained = 2e-2;

/// A corner with its bearing.
struct Sighting {
  Eigen::Vector3d p_target;
  Eigen::Vector2d px;
  Eigen::Vector3d ray;
  double px_per_rad;  ///< image scale there, mean of radial and tangential
};

std::vector<Sighting> sightings(const camera::Camera& camera, const std::vector<Eigen::Vector3d>& target_points,
                                const std::vector<observation::Corner>& corners) {
  std::vector<Sighting> result;
  result.reserve(corners.size());
  for (const observation::Corner& corner : corners) {
    const auto ray = camera::unproject(camera.model, corner.px);
    camera::Matrix23d J_px_ray;
    if (ray && camera::project(camera.model, *ray, &J_px_ray)) {
      const double px_per_rad = J_px_ray.norm() / std::sqrt(2.0);
      result.push_back({target_points.at(static_cast<std::size_t>(corner.corner_id)), corner.px, *ray, px_per_rad});
    }
  }
  return result;
}

/// The pose that maps the plane's points to the four rays, from the homography H with H [x y 1]' ~ ray: three points as a
/// basis, the fourth fixes their depths. Empty where a depth is negative or three points lie on a line.
std::optional<Rigid3> planarPose(const std::array<const Sighting*, kSampleSize>& sample) {
  Eigen::Matrix3d points;
  Eigen::Matrix3d rays;
  for (int i = 0; i < 3; ++i) {
    points.col(i) = sample[static_cast<std::size_t>(i)]->p_target.head<2>().homogeneous();
    rays.col(i) = sample[static_cast<std::size_t>(i)]->ray;
  }
  const Eigen::Matrix3d inverse = points.inverse();
  const Eigen::Vector3d a = inverse * sample[3]->p_target.head<2>().homogeneous();
  const Eigen::Vector3d depths = (rays.inverse() * sample[3]->ray).cwiseQuotient(a);
  if (!(depths.array() > 0.0).all() || !depths.allFinite()) {
    return std::nullopt;
  }
  const Eigen::Matrix3d H = rays * depths.asDiagonal() * inverse;
  const double scale = std::sqrt(H.col(0).norm() * H.col(1).norm());
  // The nearest two orthonormal columns, C (C'C)^(-1/2); the root of a 2x2 matrix M is (M + sqrt(det M) I) / its trace.
  const Eigen::Matrix<double, 3, 2> columns = H.leftCols<2>() / scale;
  const Eigen::Matrix2d square = columns.transpose() * columns;
  const double root_det = std::sqrt(square.determinant());
  const Eigen::Matrix2d root =
      (square + root_det * Eigen::Matrix2d::Identity()) / std::sqrt(square.trace() + 2.0 * root_det);
  const Eigen::Matrix<double, 3, 2> r = columns * root.inverse();
  Eigen::Matrix3d R;
  R << r, r.col(0).cross(r.col(1));
  if (!R.allFinite()) {
    return std::nullopt;
  }
  return Rigid3(R, Eigen::Vector3d(H.col(2) / scale));
}

/// Half of all corners are at least this close to where the pose puts them, approximately [px].
double medianAngularError(const std::vector<Sighting>& sightings, const Rigid3& T_cam_target, std::vector<double>& buffer) {
  buffer.clear();
  const Eigen::Matrix3d R = T_cam_target.rotation.toRotationMatrix();
  for (const Sighting& s : sightings) {
    const Eigen::Vector3d p_cam = R * s.p_target + T_cam_target.translation;
    buffer.push_back(s.px_per_rad * (p_cam.normalized() - s.ray).norm());
  }
  return upperMedian(buffer);
}

/// Least median of squares over samples of four.
std::optional<Rigid3> searchPose(const std::vector<Sighting>& sightings, double good_px) {
  Sampler sampler;
  std::optional<Rigid3> best;
  double best_px = kInfinity;
  std::vector<double> buffer;
  for (int i = 0; i < kMaxSamples && best_px > good_px; ++i) {
    std::array<std::size_t, kSampleSize> indices;
    sampler.draw(sightings.size(), indices);
    std::array<const Sighting*, kSampleSize> sample;
    for (std::size_t k = 0; k < kSampleSize; ++k) {
      sample[k] = &sightings[indices[k]];
    }
    const std::optional<Rigid3> T = planarPose(sample);
    if (!T) {
      continue;
    }
    const double error_px = medianAngularError(sightings, *T, buffer);
    if (error_px < best_px) {
      best_px = error_px;
      best = T;
    }
  }
  return best;
}

/// A pose with the median of its reprojection errors over all corners [px].
struct ScoredPose {
  Rigid3 T_cam_target;
  double median_px = kInfinity;
};

double medianError(const camera::Camera& camera, const std::vector<Sighting>& sightings, const Rigid3& T_cam_target) {
  std::vector<double> errors_px;
  for (const Sighting& s : sightings) {
    const auto px = camera::project(camera, T_cam_target * s.p_target);
    errors_px.push_back(px ? (*px - s.px).norm() : kInfinity);
  }
  return upperMedian(errors_px);
}

/// Sum of Cauchy's loss of `scale_px`; corners without an image cost as much as one 10 scales off.
double robustCost(const camera::Camera& camera, const std::vector<Sighting>& sightings, const Rigid3& T_cam_target,
                  double scale_px) {
  constexpr double kLost = 100.0;
  double cost = 0.0;
  for (const Sighting& s : sightings) {
    const auto px = camera::project(camera, T_cam_target * s.p_target);
    const double ratio2 = px ? (*px - s.px).squaredNorm() / (scale_px * scale_px) : kLost;
    cost += std::log1p(ratio2);
  }
  return cost;
}

/// The step of Levenberg-Marquardt on Cauchy's loss.
geometry::Vector6d poseStep(const camera::Camera& camera, const std::vector<Sighting>& sightings, const Rigid3& T_cam_target,
                            double scale_px, double damping) {
  geometry::Matrix6d H = geometry::Matrix6d::Zero();
  geometry::Vector6d descent = geometry::Vector6d::Zero();
  for (const Sighting& s : sightings) {
    const Eigen::Vector3d p_cam = T_cam_target * s.p_target;
    camera::Matrix23d J_px_p;
    const auto px = camera::project(camera, p_cam, &J_px_p);
    if (!px) {
      continue;
    }
    Eigen::Matrix<double, 2, 6> J;
    J << J_px_p, -J_px_p * geometry::hat(p_cam);
    const Eigen::Vector2d residual_px = s.px - *px;
    const double weight = cauchyWeight(residual_px.norm(), scale_px);
    const Eigen::Matrix<double, 6, 2> weighted = weight * J.transpose();
    H.noalias() += weighted.lazyProduct(J);
    descent.noalias() += weighted.lazyProduct(residual_px);
  }
  H.diagonal() *= 1.0 + damping;
  return geometry::solveTwist(H, descent);
}

Rigid3 refinePose(const camera::Camera& camera, const std::vector<Sighting>& sightings, Rigid3 T_cam_target,
                  double scale_px) {
  constexpr int kMaxSteps = 20;
  constexpr double kConverged = 1e-7;  // rad, and share of the distance: far below a hundredth of a pixel
  constexpr double kMaxDamping = 1e6;
  double damping = 1e-4;
  double cost = robustCost(camera, sightings, T_cam_target, scale_px);
  for (int i = 0; i < kMaxSteps && damping < kMaxDamping; ++i) {
    const geometry::Vector6d step = poseStep(camera, sightings, T_cam_target, scale_px, damping);
    if (!step.allFinite()) {
      break;
    }
    const Rigid3 next = geometry::expRigid(step) * T_cam_target;
    const double next_cost = robustCost(camera, sightings, next, scale_px);
    if (next_cost > cost) {
      damping *= 10.0;
      continue;
    }
    T_cam_target = next;
    cost = next_cost;
    damping *= 0.1;
    if (step.head<3>().norm() < kConverged * T_cam_target.translation.norm() && step.tail<3>().norm() < kConverged) {
      break;
    }
  }
  return T_cam_target;
}

/// Width of Cauchy's loss for corners of which half are within `median_px`.
double lossScale(double median_px) {
  constexpr double kMin_px = 0.5;  // corners this good are all right
  constexpr double kMax_px = 50.0;
  return std::min(std::max(2.0 * median_px, kMin_px), kMax_px);
}

/// Refines twice, the second time with a loss as narrow as the corners are good.
ScoredPose polishPose(const camera::Camera& camera, const std::vector<Sighting>& sightings, const Rigid3& start) {
  ScoredPose pose{start, medianError(camera, sightings, start)};
  for (int round = 0; round < 2; ++round) {
    const Rigid3 refined = refinePose(camera, sightings, pose.T_cam_target, lossScale(pose.median_px));
    const double median_px = medianError(camera, sightings, refined);
    if (median_px > pose.median_px) {
      break;
    }
    pose = {refined, median_px};
  }
  return pose;
}

/// The other pose from which a small board looks nearly the same: its normal mirrored at the line of sight.
Rigid3 mirroredPose(const Rigid3& T_cam_target, const Eigen::Vector3d& centre_target) {
  const Eigen::Vector3d centre_cam = T_cam_target * centre_target;
  const Eigen::Vector3d sight = centre_cam.normalized();
  const Eigen::Vector3d normal = T_cam_target.rotation * Eigen::Vector3d::UnitZ();
  const Eigen::Vector3d mirrored = 2.0 * sight.dot(normal) * sight - normal;
  const Eigen::Quaterniond R = geometry::rotationBetween(normal, mirrored) * T_cam_target.rotation;
  return Rigid3(R, centre_cam - R * centre_target);
}

Eigen::Vector3d centreOf(const std::vector<Sighting>& sightings) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Sighting& s : sightings) {
    sum += s.p_target;
  }
  return sum / static_cast<double>(sightings.size());
}

std::optional<Rigid3> estimate(const camera::Camera& camera, const std::vector<Sighting>& sightings, double diagonal_px) {
  const std::optional<Rigid3> start = searchPose(sightings, kGoodStart * diagonal_px);
  if (!start) {
    return std::nullopt;
  }
  ScoredPose best = polishPose(camera, sightings, *start);
  // The mirrored pose is worth polishing only where it does better under the same loss.
  const double scale_px = lossScale(best.median_px);
  const Rigid3 mirrored = refinePose(camera, sightings, mirroredPose(best.T_cam_target, centreOf(sightings)), scale_px);
  if (robustCost(camera, sightings, mirrored, scale_px) < robustCost(camera, sightings, best.T_cam_target, scale_px)) {
    best = polishPose(camera, sightings, mirrored);
  }
  if (!(best.median_px < kExplained * diagonal_px)) {
    return std::nullopt;
  }
  return best.T_cam_target;
}

}  // namespace

std::optional<Rigid3> estimatePose(const camera::Camera& camera, const std::vector<Eigen::Vector3d>& target_points,
                                   const std::vector<observation::Corner>& corners) {
  const std::vector<Sighting> seen = sightings(camera, target_points, corners);
  if (seen.size() < kSampleSize || 2 * seen.size() < corners.size()) {
    return std::nullopt;
  }
  return estimate(camera, seen, std::hypot(camera.width, camera.height));
}

std::vector<std::optional<Rigid3>> estimatePoses(const camera::Camera& camera,
                                                 const std::vector<Eigen::Vector3d>& target_points,
                                                 const std::vector<observation::CameraView>& images, int num_threads) {
  std::vector<std::optional<Rigid3>> poses(images.size());
  solver::forEachItem(static_cast<int>(images.size()), num_threads,
                      [&](std::size_t i) { poses[i] = estimatePose(camera, target_points, images[i].corners); });
  return poses;
}

}  // namespace tartan_calib::calibration
