#include "model_fit.h"

#include <algorithm>
#include <cmath>

#include "tartan_calib/geometry/linear_solve.h"

namespace tartan_calib::calibration {
namespace {

using camera::CameraModel;

/// Sum of squared distances; a ray without an image costs as much as one that is a focal length off.
double cost(const CameraModel& model, double focal_px, const std::vector<RayPixel>& pairs) {
  double sum_px2 = 0.0;
  for (const RayPixel& pair : pairs) {
    const auto px = camera::project(model, pair.ray);
    sum_px2 += px ? (*px - pair.px).squaredNorm() : focal_px * focal_px;
  }
  return sum_px2;
}

Eigen::VectorXd levenbergStep(const CameraModel& model, const std::vector<RayPixel>& pairs, double damping) {
  constexpr double kMinDiagonal = 1e-12;  // of the largest: parameters that nothing depends on stay
  const int size = camera::numParameters(model);
  Eigen::MatrixXd H = Eigen::MatrixXd::Zero(size, size);
  Eigen::VectorXd descent = Eigen::VectorXd::Zero(size);
  camera::ParameterJacobian J(2, size);
  for (const RayPixel& pair : pairs) {
    if (const auto px = camera::project(model, pair.ray, nullptr, &J)) {
      H.noalias() += J.transpose().lazyProduct(J);
      descent.noalias() += J.transpose().lazyProduct(pair.px - *px);
    }
  }
  const double floor = kMinDiagonal * H.diagonal().maxCoeff();
  H.diagonal() = (1.0 + damping) * H.diagonal().array() + floor;
  return geometry::solveSymmetric(H, descent);
}

CameraModel fit(CameraModel model, double focal_px, const std::vector<RayPixel>& pairs) {
  constexpr int kMaxSteps = 100;
  constexpr double kConverged = 1e-6;  // relative decrease of the cost
  constexpr double kMaxDamping = 1e8;
  double damping = 1e-3;
  const Eigen::VectorXd lower = camera::lowerBound(model);
  const Eigen::VectorXd upper = camera::upperBound(model);
  double current = cost(model, focal_px, pairs);
  for (int i = 0; i < kMaxSteps && damping < kMaxDamping; ++i) {
    const Eigen::VectorXd step = levenbergStep(model, pairs, damping);
    if (!step.allFinite()) {
      break;
    }
    const Eigen::VectorXd moved = camera::parameters(model) + step;
    const CameraModel next = camera::withParameters(model, moved.cwiseMax(lower).cwiseMin(upper));
    const double next_cost = cost(next, focal_px, pairs);
    if (!(next_cost < current)) {
      damping *= 10.0;
      continue;
    }
    const bool is_converged = current - next_cost < kConverged * current;
    model = next;
    current = next_cost;
    damping *= 0.1;
    if (is_converged) {
      break;
    }
  }
  return model;
}

/// Those that the start model sees at no more than 10 times the image scale of its centre.
std::vector<RayPixel> usablePairs(const CameraModel& start, double focal_px, const std::vector<RayPixel>& pairs) {
  constexpr double kMaxMagnification = 10.0;
  std::vector<RayPixel> usable;
  for (const RayPixel& pair : pairs) {
    camera::Matrix23d J_px_ray;
    if (camera::project(start, pair.ray, &J_px_ray) && J_px_ray.norm() < kMaxMagnification * focal_px) {
      usable.push_back(pair);
    }
  }
  return usable;
}

struct Fit {
  CameraModel model;
  double rms_px;
};

/// Focal lengths in the image centre differ by more than the fit could mistake.
bool isSameMinimum(const Fit& a, const Fit& b) {
  constexpr double kSame = 0.02;
  const int focal = camera::focalIndex(a.model);
  const double focal_a = camera::parameters(a.model)(focal);
  const double focal_b = camera::parameters(b.model)(focal);
  return std::abs(focal_a - focal_b) < kSame * std::max(focal_a, focal_b);
}

/// The different minima that are reached from starts of several focal lengths, best first.
std::vector<Fit> minima(const CameraModel& kind, double focal_px, const Eigen::Vector2d& principal_point_px,
                        const std::vector<RayPixel>& pairs) {
  const std::vector<RayPixel> usable = usablePairs(camera::startModel(kind, focal_px, principal_point_px), focal_px, pairs);
  std::vector<Fit> fits;
  for (const double factor : {1.0, 0.5, 2.0}) {
    const CameraModel model = fit(camera::startModel(kind, factor * focal_px, principal_point_px), focal_px, usable);
    fits.push_back({model, std::sqrt(cost(model, focal_px, usable) / static_cast<double>(usable.size()))});
  }
  std::stable_sort(fits.begin(), fits.end(), [](const auto& a, const auto& b) { return a.rms_px < b.rms_px; });
  std::vector<Fit> different;
  for (const Fit& candidate : fits) {
    if (std::none_of(different.begin(), different.end(), [&](const auto& f) { return isSameMinimum(f, candidate); })) {
      different.push_back(candidate);
    }
  }
  return different;
}

}  // namespace

std::vector<camera::CameraModel> fitModels(const camera::CameraModel& kind, double focal_px,
                                           const Eigen::Vector2d& principal_point_px, const std::vector<RayPixel>& pairs) {
  // The profile that the pairs come from is an approximation, good to 2 px in tests: minima this close cannot be told apart.
  constexpr double kMargin = 1e-2;  // of the focal length
  std::vector<CameraModel> models;
  const std::vector<Fit> fits = minima(kind, focal_px, principal_point_px, pairs);
  for (const Fit& fit : fits) {
    if (fit.rms_px <= fits.front().rms_px + kMargin * focal_px) {
      models.push_back(fit.model);
    }
  }
  return models;
}

}  // namespace tartan_calib::calibration
