#include "radial_pose.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <cmath>
#include <complex>
#include <limits>

#include "robust.h"
#include "tartan_calib/median.h"

namespace tartan_calib::calibration {
namespace {

using Matrix6d = Eigen::Matrix<double, 6, 6>;
using Vector6d = Eigen::Matrix<double, 6, 1>;

constexpr std::size_t kSampleSize = 6;  ///< one more than the constraint needs, against noise
/// With 20 % wrong corners a sample is right with probability 0.26: 60 samples miss once in 10^8.
constexpr int kMaxSamples = 60;
/// Half of the corners this close, as a share of half the image's width: no need to look further.
constexpr double kGoodStart = 5e-4;
/// Noise of any detector that is of use, as a share of half the image's width.
constexpr double kCostScale = 3e-3;
constexpr double kMinScale = 2e-4;

/// (image - centre) x (H [board; 1]) = row * (H row by row).
Vector6d constraintRow(const NormalCorner& corner, const Eigen::Vector2d& centre) {
  const Eigen::Vector2d x = corner.image - centre;
  const Eigen::Vector3d X = corner.board.homogeneous();
  Vector6d row;
  row << -x.y() * X, x.x() * X;
  return row;
}

/// The unit homography with the smallest x' A x.
RadialHomography smallestEigenvector(const Matrix6d& A) {
  const Eigen::SelfAdjointEigenSolver<Matrix6d> solver(A);
  const Vector6d h = solver.eigenvectors().col(0);
  RadialHomography H;
  H << h.head<3>().transpose(), h.tail<3>().transpose();
  return H;
}

/// Of the two signs the one with most corners on their half-lines.
RadialHomography withSign(const RadialHomography& H, const Eigen::Vector2d& centre, const NormalView& view) {
  int balance = 0;
  for (const NormalCorner& corner : view) {
    balance += (corner.image - centre).dot(H * corner.board.homogeneous()) > 0.0 ? 1 : -1;
  }
  return balance < 0 ? RadialHomography(-H) : H;
}

double medianError(const RadialHomography& H, const Eigen::Vector2d& centre, const NormalView& view,
                   std::vector<double>& buffer) {
  buffer.clear();
  for (const NormalCorner& corner : view) {
    buffer.push_back(radialError(H, centre, corner));
  }
  return upperMedian(buffer);
}

}  // namespace

double radialError(const RadialHomography& H, const Eigen::Vector2d& centre, const NormalCorner& corner) {
  const Eigen::Vector2d x = corner.image - centre;
  const Eigen::Vector2d direction = H * corner.board.homogeneous();
  if (x.dot(direction) <= 0.0) {
    return x.norm();
  }
  return std::abs(x.x() * direction.y() - x.y() * direction.x()) / direction.norm();
}

std::optional<RadialHomography> searchRadialHomography(const NormalView& view, const Eigen::Vector2d& centre) {
  if (view.size() < kSampleSize) {
    return std::nullopt;
  }
  // Points far from the centre must not rule the sample: rows are weighted as if their errors were angles.
  constexpr double kMinRadius = 0.05;
  Sampler sampler;
  std::vector<double> buffer;
  RadialHomography best = RadialHomography::Zero();
  double best_error = std::numeric_limits<double>::infinity();
  for (int i = 0; i < kMaxSamples && best_error > kGoodStart; ++i) {
    std::array<std::size_t, kSampleSize> indices;
    sampler.draw(view.size(), indices);
    Matrix6d A = Matrix6d::Zero();
    for (const std::size_t index : indices) {
      const Vector6d row = constraintRow(view[index], centre) / ((view[index].image - centre).norm() + kMinRadius);
      A += row * row.transpose();
    }
    const RadialHomography H = withSign(smallestEigenvector(A), centre, view);
    const double error = medianError(H, centre, view, buffer);
    if (error < best_error) {
      best_error = error;
      best = H;
    }
  }
  return refineRadialHomography(view, centre, best);
}

RadialHomography refineRadialHomography(const NormalView& view, const Eigen::Vector2d& centre, const RadialHomography& H) {
  constexpr int kRounds = 4;
  constexpr double kMinNorm = 1e-9;
  std::vector<double> buffer;
  RadialHomography best = H;
  double best_error = medianError(H, centre, view, buffer);
  for (int round = 0; round < kRounds; ++round) {
    const double scale = std::max(2.0 * best_error, kMinScale);
    Matrix6d A = Matrix6d::Zero();
    for (const NormalCorner& corner : view) {
      const double norm = (best * corner.board.homogeneous()).norm();
      const double weight = cauchyWeight(radialError(best, centre, corner), scale);
      const Vector6d row = constraintRow(corner, centre);
      A += (weight / std::max(norm * norm, kMinNorm)) * row * row.transpose();
    }
    const RadialHomography next = withSign(smallestEigenvector(A), centre, view);
    const double error = medianError(next, centre, view, buffer);
    if (!(error < best_error)) {
      break;
    }
    best = next;
    best_error = error;
  }
  return best;
}

std::array<RadialPose, 2> completeRotation(const RadialHomography& H) {
  // r1 = (h1, a), r2 = (h2, b) of equal norm and orthogonal: a^2 - b^2 = |h2|^2 - |h1|^2, a b = -h1.h2.
  const Eigen::Vector2d h1 = H.col(0);
  const Eigen::Vector2d h2 = H.col(1);
  const std::complex<double> ab = std::sqrt(std::complex<double>(h2.squaredNorm() - h1.squaredNorm(), -2.0 * h1.dot(h2)));
  const double scale = 1.0 / std::sqrt(h1.squaredNorm() + ab.real() * ab.real());
  std::array<RadialPose, 2> poses;
  for (std::size_t i = 0; i < 2; ++i) {
    const double sign = i == 0 ? 1.0 : -1.0;
    poses[i].R_columns << h1.x(), h2.x(), h1.y(), h2.y(), sign * ab.real(), sign * ab.imag();
    poses[i].R_columns *= scale;
    poses[i].t = scale * H.col(2);
  }
  return poses;
}

double radialCost(const RadialHomography& H, const Eigen::Vector2d& centre, const NormalView& view) {
  double cost = 0.0;
  for (const NormalCorner& corner : view) {
    const double ratio = radialError(H, centre, corner) / kCostScale;
    cost += std::log1p(ratio * ratio);
  }
  return cost / static_cast<double>(view.size());
}

}  // namespace tartan_calib::calibration
