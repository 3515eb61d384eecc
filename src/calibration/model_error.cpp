#include "model_error.h"

#include <cmath>

namespace tartan_calib::calibration {
namespace {

constexpr double kMaxError_px = 30.0;
constexpr int kBisections = 50;

struct Residual {
  Eigen::Vector2d squared_px2;
  Eigen::Vector2d variance_px2;  ///< of the corner as detected
};

std::vector<std::vector<Residual>> usedResiduals(const BatchProblem& batch) {
  std::vector<std::vector<Residual>> residuals(batch.state().rig.cameras.size());
  for (std::size_t view = 0; view < batch.views().size(); ++view) {
    for (const CameraMeasurements& image : batch.views()[view]) {
      const std::vector<std::optional<Eigen::Vector2d>> errors_px = batch.errors(view, image);
      for (std::size_t i = 0; i < errors_px.size(); ++i) {
        if (image.corners[i].state == CornerState::kUsed && errors_px[i]) {
          residuals[static_cast<std::size_t>(image.camera_index)].push_back(
              {errors_px[i]->cwiseAbs2(), image.corners[i].cov_px2.diagonal()});
        }
      }
    }
  }
  return residuals;
}

double meanNormalisedSquare(const std::vector<Residual>& residuals, double model_variance_px2) {
  double sum = 0.0;
  for (const Residual& residual : residuals) {
    sum += (residual.squared_px2.array() / (residual.variance_px2.array() + model_variance_px2)).sum();
  }
  return sum / (2.0 * static_cast<double>(residuals.size()));
}

double modelError(const std::vector<Residual>& residuals) {
  if (residuals.empty() || meanNormalisedSquare(residuals, 0.0) <= 1.0) {
    return 0.0;
  }
  double low = 0.0;
  double high = kMaxError_px;
  for (int i = 0; i < kBisections; ++i) {
    const double middle = 0.5 * (low + high);
    (meanNormalisedSquare(residuals, middle * middle) > 1.0 ? low : high) = middle;
  }
  return high;
}

}  // namespace

std::vector<double> modelErrors(const BatchProblem& batch) {
  std::vector<double> sigmas_px;
  for (const std::vector<Residual>& residuals : usedResiduals(batch)) {
    sigmas_px.push_back(modelError(residuals));
  }
  return sigmas_px;
}

void setModelErrors(const std::vector<double>& sigmas_px, BatchProblem& batch) {
  for (ViewMeasurements& view : batch.views()) {
    for (CameraMeasurements& image : view) {
      const double sigma_px = sigmas_px[static_cast<std::size_t>(image.camera_index)];
      for (Measurement& corner : image.corners) {
        corner.sqrt_information = sqrtInformation(corner.cov_px2 + sigma_px * sigma_px * Eigen::Matrix2d::Identity());
      }
    }
  }
}

}  // namespace tartan_calib::calibration
