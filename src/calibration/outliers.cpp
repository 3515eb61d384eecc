#include "outliers.h"

#include <algorithm>
#include <cmath>

#include "tartan_calib/median.h"

namespace tartan_calib::calibration {
namespace {

constexpr double kMadToSigma = 1.4826;  ///< of a normal distribution
constexpr double kMinSigma = 1e-3;      ///< [px]; no detector is better, and rounding is no outlier
constexpr double kGrossSigma = 10.0;    ///< robust stdevs: beyond any misfit of a model, short of a wrong corner
/// A lens is off its formula by so much even where corners are seen ten times better. Judged by the corners' noise alone,
/// the outer ones, where a model that is too simple errs most, would all be outliers, and the model worse for it.
constexpr double kUsualMisfit_px = 0.1;
constexpr double kNeverOutlier_px = 0.3;  ///< no wrong corner lies this close
/// Where a model is too simple by tenths of a pixel it errs most at the rim, there for all corners: 4 stdevs of all corners
/// would take the rim away. Corners up to this far off may stay there. Such a model is told from noise by errors that are so
/// many times what the corners' covariances say.
constexpr double kMisfitNeverOutlier_px = 1.2;
constexpr double kMisfit_ratio = 4.0;
constexpr int kMinPoseCorners = 4;   ///< of a view: fewer leave its pose undetermined or ambiguous
constexpr int kMaxSigmaPasses = 20;  ///< rejection lowers sigma, which rejects more; settles within a few passes

/// A corner that has an image, with its error.
struct Candidate {
  Measurement* corner = nullptr;
  Eigen::Vector2d error_px;  ///< measured - predicted
};

double robustSigma(std::vector<double>& magnitudes) {
  return magnitudes.empty() ? kMinSigma : std::max(kMinSigma, kMadToSigma * upperMedian(magnitudes));
}

/// Of the errors of all corners along the axes [px].
double robustSigma(const std::vector<Candidate>& candidates) {
  std::vector<double> magnitudes;
  for (const Candidate& candidate : candidates) {
    magnitudes.push_back(std::abs(candidate.error_px.x()));
    magnitudes.push_back(std::abs(candidate.error_px.y()));
  }
  return robustSigma(magnitudes);
}

/// By camera, all corners that have an image, set to used; the others are marked.
std::vector<std::vector<Candidate>> projectableCorners(BatchProblem& batch) {
  std::vector<std::vector<Candidate>> candidates(batch.state().rig.cameras.size());
  for (std::size_t view = 0; view < batch.views().size(); ++view) {
    for (CameraMeasurements& image : batch.views()[view]) {
      const std::vector<std::optional<Eigen::Vector2d>> errors_px = batch.errors(view, image);
      for (std::size_t i = 0; i < errors_px.size(); ++i) {
        Measurement& corner = image.corners[i];
        corner.state = errors_px[i] ? CornerState::kUsed : CornerState::kUnprojectable;
        if (errors_px[i]) {
          candidates[static_cast<std::size_t>(image.camera_index)].push_back({&corner, *errors_px[i]});
        }
      }
    }
  }
  return candidates;
}

/// Marks used corners beyond the limit in u or v. True where there were any.
bool rejectBeyond(const Eigen::Array2d& limit_px, const std::vector<Candidate>& candidates) {
  bool is_any = false;
  for (const Candidate& candidate : candidates) {
    if (candidate.corner->state == CornerState::kUsed && (candidate.error_px.array().abs() > limit_px).any()) {
      candidate.corner->state = CornerState::kOutlier;
      is_any = true;
    }
  }
  return is_any;
}

void rejectGross(const std::vector<Candidate>& candidates) {
  const double sigma_px = std::max(robustSigma(candidates), kUsualMisfit_px);
  rejectBeyond(Eigen::Array2d::Constant(kGrossSigma * sigma_px), candidates);
}

/// Population stdev per axis of the used corners' errors.
Eigen::Array2d stdevOfUsed(const std::vector<Candidate>& candidates) {
  double num_used = 0.0;
  Eigen::Array2d sum = Eigen::Array2d::Zero();
  Eigen::Array2d sum_of_squares = Eigen::Array2d::Zero();
  for (const Candidate& candidate : candidates) {
    if (candidate.corner->state == CornerState::kUsed) {
      num_used += 1.0;
      sum += candidate.error_px.array();
      sum_of_squares += candidate.error_px.array().square();
    }
  }
  const double n = std::max(1.0, num_used);
  return (sum_of_squares / n - (sum / n).square()).max(0.0).sqrt().max(kMinSigma);
}

/// No corner closer than this [px] is an outlier.
double harmlessError_px(const std::vector<Candidate>& candidates) {
  std::vector<double> own_sigmas_px;
  for (const Candidate& candidate : candidates) {
    own_sigmas_px.push_back(std::sqrt(0.5 * candidate.corner->cov_px2.trace()));
  }
  const double sigma_px = robustSigma(candidates);
  const bool is_misfit = !own_sigmas_px.empty() && sigma_px > kMisfit_ratio * upperMedian(own_sigmas_px);
  return is_misfit ? std::clamp(kGrossSigma * sigma_px, kNeverOutlier_px, kMisfitNeverOutlier_px) : kNeverOutlier_px;
}

/// Kalibr's rule, which it applies after every view it adds: here until it rejects no more.
void rejectBySigma(double outlier_sigma, const std::vector<Candidate>& candidates) {
  const double harmless_px = harmlessError_px(candidates);
  for (int pass = 0; pass < kMaxSigmaPasses; ++pass) {
    if (!rejectBeyond((outlier_sigma * stdevOfUsed(candidates)).max(harmless_px), candidates)) {
      return;
    }
  }
}

void rejectUnsupported(BatchProblem& batch) {
  for (ViewMeasurements& view : batch.views()) {
    int num_used = 0;
    for (const CameraMeasurements& image : view) {
      num_used += static_cast<int>(std::count_if(image.corners.begin(), image.corners.end(), [](const Measurement& corner) {
        return corner.state == CornerState::kUsed;
      }));
    }
    if (num_used >= kMinPoseCorners) {
      continue;
    }
    for (CameraMeasurements& image : view) {
      for (Measurement& corner : image.corners) {
        corner.state = corner.state == CornerState::kUsed ? CornerState::kUnsupported : corner.state;
      }
    }
  }
}

std::vector<CornerState> cornerStates(const BatchProblem& batch) {
  std::vector<CornerState> states;
  for (const ViewMeasurements& view : batch.views()) {
    for (const CameraMeasurements& image : view) {
      for (const Measurement& corner : image.corners) {
        states.push_back(corner.state);
      }
    }
  }
  return states;
}

std::vector<int> viewsPerCamera(const BatchProblem& batch) {
  std::vector<int> num_views(batch.state().rig.cameras.size(), 0);
  for (const ViewMeasurements& view : batch.views()) {
    for (const CameraMeasurements& image : view) {
      num_views[static_cast<std::size_t>(image.camera_index)] += image.corners.empty() ? 0 : 1;
    }
  }
  return num_views;
}

}  // namespace

std::vector<double> robustSigmas(const BatchProblem& batch) {
  const std::size_t num_cameras = batch.state().rig.cameras.size();
  std::vector<std::vector<double>> magnitudes(num_cameras);
  std::vector<std::vector<double>> inverse_sigmas(num_cameras);  // of the corners as detected, 1/px
  for (std::size_t view = 0; view < batch.views().size(); ++view) {
    for (const CameraMeasurements& image : batch.views()[view]) {
      std::vector<double>& list = magnitudes[static_cast<std::size_t>(image.camera_index)];
      const std::vector<std::optional<Eigen::Vector2d>> errors_px = batch.errors(view, image);
      for (std::size_t i = 0; i < errors_px.size(); ++i) {
        if (image.corners[i].state == CornerState::kUsed && errors_px[i]) {
          const Eigen::Vector2d whitened = image.corners[i].sqrt_information * *errors_px[i];
          list.push_back(std::abs(whitened.x()));
          list.push_back(std::abs(whitened.y()));
          inverse_sigmas[static_cast<std::size_t>(image.camera_index)].push_back(
              std::sqrt(image.corners[i].sqrt_information.determinant()));
        }
      }
    }
  }
  std::vector<double> sigmas;
  for (std::size_t i = 0; i < num_cameras; ++i) {
    const double misfit = inverse_sigmas[i].empty() ? 0.0 : kUsualMisfit_px * upperMedian(inverse_sigmas[i]);
    sigmas.push_back(std::max(robustSigma(magnitudes[i]), misfit));
  }
  return sigmas;
}

bool selectCorners(const SolveOptions& options, Selection selection, BatchProblem& batch) {
  const std::vector<CornerState> before = cornerStates(batch);
  const std::vector<int> num_views = viewsPerCamera(batch);
  const std::vector<std::vector<Candidate>> candidates = projectableCorners(batch);
  for (std::size_t i = 0; i < candidates.size() && options.remove_outliers; ++i) {
    rejectGross(candidates[i]);
    if (selection == Selection::kAllRules && num_views[i] > options.min_views_outlier) {
      rejectBySigma(options.outlier_sigma, candidates[i]);
    }
  }
  rejectUnsupported(batch);
  return cornerStates(batch) != before;
}

}  // namespace tartan_calib::calibration
