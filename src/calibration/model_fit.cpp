#include "model_fit.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace tartan_calib::calibration {
namespace {

/// Sum of squared distances; a ray without an image costs as much as one that is a focal length off.
template <typename Model>
double cost(const Model& model, double focal_px, const std::vector<RayPixel>& pairs) {
  double sum_px2 = 0.0;
  for (const RayPixel& pair : pairs) {
    Eigen::Vector2d px;
    sum_px2 += model.project(pair.ray, px) ? (px - pair.px).squaredNorm() : focal_px * focal_px;
  }
  return sum_px2;
}

template <typename Model>
typename Model::Parameters levenbergStep(const Model& model, const std::vector<RayPixel>& pairs, double damping) {
  constexpr double kMinDiagonal = 1e-12;  // of the largest: parameters that nothing depends on stay
  constexpr int kSize = Model::kNumParameters;
  Eigen::Matrix<double, kSize, kSize> H = Eigen::Matrix<double, kSize, kSize>::Zero();
  typename Model::Parameters descent = Model::Parameters::Zero();
  for (const RayPixel& pair : pairs) {
    Eigen::Vector2d px;
    typename Model::ParameterJacobian J;
    if (model.project(pair.ray, px, nullptr, &J)) {
      H += J.transpose() * J;
      descent += J.transpose() * (pair.px - px);
    }
  }
  const double floor = kMinDiagonal * H.diagonal().maxCoeff();
  H.diagonal() += damping * H.diagonal() + Model::Parameters::Constant(floor);
  return H.ldlt().solve(descent);
}

template <typename Model>
Model fit(Model model, double focal_px, const std::vector<RayPixel>& pairs) {
  constexpr int kMaxSteps = 100;
  constexpr double kConverged = 1e-6;  // relative decrease of the cost
  constexpr double kMaxDamping = 1e8;
  double damping = 1e-3;
  double current = cost(model, focal_px, pairs);
  for (int i = 0; i < kMaxSteps && damping < kMaxDamping; ++i) {
    const typename Model::Parameters step = levenbergStep(model, pairs, damping);
    if (!step.allFinite()) {
      break;
    }
    const Model next(
        typename Model::Parameters((model.parameters() + step).cwiseMax(Model::lowerBound()).cwiseMin(Model::upperBound())));
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
template <typename Model>
std::vector<RayPixel> usablePairs(const Model& start, double focal_px, const std::vector<RayPixel>& pairs) {
  constexpr double kMaxMagnification = 10.0;
  std::vector<RayPixel> usable;
  for (const RayPixel& pair : pairs) {
    Eigen::Vector2d px;
    camera::Matrix23d J_px_ray;
    if (start.project(pair.ray, px, &J_px_ray) && J_px_ray.norm() < kMaxMagnification * focal_px) {
      usable.push_back(pair);
    }
  }
  return usable;
}

template <typename Model>
struct Fit {
  Model model;
  double rms_px;
};

/// Focal lengths in the image centre differ by more than the fit could mistake.
template <typename Model>
bool isSameMinimum(const Fit<Model>& a, const Fit<Model>& b) {
  constexpr double kSame = 0.02;
  const double focal_a = a.model.parameters()(Model::kFocalIndex);
  const double focal_b = b.model.parameters()(Model::kFocalIndex);
  return std::abs(focal_a - focal_b) < kSame * std::max(focal_a, focal_b);
}

/// The different minima that are reached from starts of several focal lengths, best first.
template <typename Model>
std::vector<Fit<Model>> minima(double focal_px, const Eigen::Vector2d& principal_point_px,
                               const std::vector<RayPixel>& pairs) {
  const std::vector<RayPixel> usable = usablePairs(Model(Model::start(focal_px, principal_point_px)), focal_px, pairs);
  std::vector<Fit<Model>> fits;
  for (const double factor : {1.0, 0.5, 2.0}) {
    const Model model = fit(Model(Model::start(factor * focal_px, principal_point_px)), focal_px, usable);
    fits.push_back({model, std::sqrt(cost(model, focal_px, usable) / static_cast<double>(usable.size()))});
  }
  std::stable_sort(fits.begin(), fits.end(), [](const auto& a, const auto& b) { return a.rms_px < b.rms_px; });
  std::vector<Fit<Model>> different;
  for (const Fit<Model>& candidate : fits) {
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
  return std::visit(
      [&](const auto& model) {
        std::vector<camera::CameraModel> models;
        const auto fits = minima<std::decay_t<decltype(model)>>(focal_px, principal_point_px, pairs);
        for (const auto& fit : fits) {
          if (fit.rms_px <= fits.front().rms_px + kMargin * focal_px) {
            models.push_back(fit.model);
          }
        }
        return models;
      },
      kind);
}

}  // namespace tartan_calib::calibration
