#include "tartan_calib/calibration/solve.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "batch_problem.h"
#include "model_error.h"
#include "outliers.h"
#include "rig_covariance.h"
#include "tartan_calib/error.h"
#include "tartan_calib/solver/covariance.h"
#include "tartan_calib/solver/levenberg_marquardt.h"

namespace tartan_calib::calibration {
namespace {

constexpr std::array<double, 3> kCauchyWidths = {5.0, 2.0, 1.0};  ///< in robust stdevs of each camera's residuals
constexpr int kMaxSelections = 4;                                 ///< rounds of choosing corners and solving; two are usual

/// When a minimum is reached, as shares of the cost.
struct Accuracy {
  double tolerance = 0.0;   ///< that the next step would lower it by
  double negligible = 0.0;  ///< that steps may promise and not keep
  double initial_damping = 0.0;
  double newton_damping = 0.0;
};

/// Of a stage after which corners are weighted or chosen anew: the next step would move predictions by a hundredth of the
/// residuals. Damping that hides more along a valley is of no consequence for predictions.
constexpr Accuracy kRough = {1e-4, 1e-4, 1e-6, 1e-6};

/// Of the last stage: the next step would move no parameter by more than a thousandth of its stdev.
Accuracy finalAccuracy(int num_corners) {
  constexpr double kFinalStdevs = 1e-3;
  // Steps that fail although they promise to move parameters by so much: ds-none has a valley so flat and bent where few
  // views are narrow. There the place in the valley is of no consequence for the image.
  constexpr double kNegligibleStdevs = 0.05;
  // With H the normal matrix and sigma^2 = 2 cost / n, a step d of e stdevs promises d'Hd / 2 = e^2 sigma^2 / 2.
  const double ratio_per_stdev2 = 1.0 / (2.0 * num_corners);
  return {kFinalStdevs * kFinalStdevs * ratio_per_stdev2, kNegligibleStdevs * kNegligibleStdevs * ratio_per_stdev2, 1e-8,
          1e-9};
}

constexpr double kExactResidual_px = 1e-9;  ///< data without noise are fitted to this rms

struct UsedCorners {
  int num_corners = 0;
  double sum_of_squares_px2 = 0.0;
  double sum_of_whitened_squares = 0.0;
};

solver::LinearSolver solverChoice(LinearSolver choice) {
  switch (choice) {
    case LinearSolver::kSchur:
      return solver::LinearSolver::kSchur;
    case LinearSolver::kSparse:
      return solver::LinearSolver::kSparse;
    case LinearSolver::kAuto:
      break;
  }
  return solver::LinearSolver::kAuto;
}

SolveStatus statusOf(solver::Status status) {
  switch (status) {
    case solver::Status::kConverged:
      return SolveStatus::kConverged;
    case solver::Status::kMaxIterations:
      return SolveStatus::kMaxIterations;
    case solver::Status::kCancelled:
      return SolveStatus::kCancelled;
    case solver::Status::kStalled:
      break;
  }
  return SolveStatus::kStalled;
}

UsedCorners usedCorners(const BatchProblem& batch) {
  UsedCorners used;
  for (std::size_t view = 0; view < batch.views().size(); ++view) {
    for (const CameraMeasurements& image : batch.views()[view]) {
      const std::vector<std::optional<Eigen::Vector2d>> errors_px = batch.errors(view, image);
      for (std::size_t i = 0; i < errors_px.size(); ++i) {
        if (image.corners[i].state == CornerState::kUsed && errors_px[i]) {
          ++used.num_corners;
          used.sum_of_squares_px2 += errors_px[i]->squaredNorm();
          used.sum_of_whitened_squares += (image.corners[i].sqrt_information * *errors_px[i]).squaredNorm();
        }
      }
    }
  }
  return used;
}

/// The stages of a solve and what they leave behind.
class BatchSolve {
 public:
  BatchSolve(const Problem& problem, const SolveOptions& options)
      : problem_(problem), options_(options), batch_(problem, options) {}

  Solution run() {
    anneal();
    if (!options_.only_robust) {
      leastSquares();
    }
    keepStartOfUnsolvedViews();
    return solution();
  }

 private:
  bool isCancelled() const { return status_ == SolveStatus::kCancelled; }
  int numAnnealingStages() const { return options_.anneal_robust_loss ? static_cast<int>(kCauchyWidths.size()) : 0; }

  /// Robust losses of falling width, each as a fraction of what the residuals are by then.
  void anneal() {
    for (int stage = 0; stage < numAnnealingStages() && !isCancelled(); ++stage) {
      std::vector<RobustLoss> losses;
      for (const double sigma : robustSigmas(batch_)) {
        losses.push_back({RobustLoss::Kind::kCauchy, kCauchyWidths[static_cast<std::size_t>(stage)] * sigma});
      }
      batch_.setLosses(std::move(losses));
      minimize(stage, kRough);
    }
  }

  /// Chooses corners and solves until the choice stays the same.
  void leastSquares() {
    const RobustLoss loss{options_.use_blake_zisserman ? RobustLoss::Kind::kBlakeZisserman : RobustLoss::Kind::kLeastSquares,
                          1.0};
    batch_.setLosses(std::vector<RobustLoss>(problem_.rig.cameras.size(), loss));
    const int num_selections = options_.final_filtering ? kMaxSelections : 1;
    for (int i = 0; i <= num_selections && !isCancelled(); ++i) {
      // The annealed model follows the bulk of the corners; the sigma rule waits for one that follows all but gross errors.
      const bool is_rough = i == 0;
      const bool is_changed = selectCorners(options_, is_rough ? Selection::kGrossErrors : Selection::kAllRules, batch_);
      if (!is_changed && i > 1) {
        return;
      }
      const int num_corners = usedCorners(batch_).num_corners;
      if (num_corners == 0) {
        throw CalibrationError("no corner fits the start of the solve; the start values are too far off");
      }
      model_errors_px_ = modelErrors(batch_);
      setModelErrors(model_errors_px_, batch_);
      minimize(numAnnealingStages() + i, is_rough ? kRough : finalAccuracy(num_corners));
    }
  }

  void minimize(int stage, const Accuracy& accuracy) {
    const double num_residuals = 2.0 * std::max(1, usedCorners(batch_).num_corners);
    solver::Options options;
    options.linear_solver = solverChoice(options_.linear_solver);
    options.num_threads = options_.num_threads;
    options.max_iterations = options_.max_iterations;
    options.relative_tolerance = accuracy.tolerance;
    options.negligible_ratio = accuracy.negligible;
    options.initial_damping = accuracy.initial_damping;
    options.newton_damping = accuracy.newton_damping;
    options.absolute_tolerance = 0.5 * num_residuals * kExactResidual_px * kExactResidual_px;
    if (options_.progress) {
      options.progress = [&, stage, num_residuals](int iteration, double cost) {
        const int num_stages = numAnnealingStages() + 1 + (options_.final_filtering ? kMaxSelections : 1);
        return options_.progress({stage, num_stages, iteration, std::sqrt(4.0 * cost / num_residuals)});
      };
    }
    const solver::Summary summary = solver::minimize(batch_, options);
    iterations_ += summary.iterations;
    status_ = statusOf(summary.status);
  }

  static bool isSolved(const ViewMeasurements& view) {
    return std::any_of(view.begin(), view.end(), [](const CameraMeasurements& image) {
      return std::any_of(image.corners.begin(), image.corners.end(),
                         [](const Measurement& corner) { return corner.state == CornerState::kUsed; });
    });
  }

  void keepStartOfUnsolvedViews() {
    for (std::size_t view = 0; view < batch_.views().size(); ++view) {
      if (!isSolved(batch_.views()[view])) {
        batch_.setPose(view, problem_.T_rig_target[view]);
      }
    }
  }

  Solution solution() const {
    Solution solution;
    solution.status = status_;
    solution.iterations = iterations_;
    solution.rig = batch_.state().rig;
    solution.T_rig_target = batch_.state().T_rig_target;
    solution.board_warp_m = batch_.state().board_warp_m;
    solution.model_errors_px = model_errors_px_;
    copyCorners(solution);
    if (!isCancelled() && !options_.only_robust) {
      estimateUncertainty(solution);
    }
    return solution;
  }

  void copyCorners(Solution& solution) const {
    solution.views = problem_.views;
    solution.counts.resize(problem_.rig.cameras.size());
    for (std::size_t view = 0; view < solution.views.size(); ++view) {
      const ViewMeasurements& measured = batch_.views()[view];
      for (std::size_t i = 0; i < measured.size(); ++i) {
        CornerCounts& counts = solution.counts[static_cast<std::size_t>(measured[i].camera_index)];
        for (std::size_t j = 0; j < measured[i].corners.size(); ++j) {
          const CornerState state = measured[i].corners[j].state;
          solution.views[view].cameras[i].corners[j].used = state == CornerState::kUsed;
          count(state, counts);
        }
      }
      if (!isSolved(measured)) {
        solution.unsolved_views.push_back(static_cast<int>(view));
      }
    }
  }

  static void count(CornerState state, CornerCounts& counts) {
    switch (state) {
      case CornerState::kUsed:
        ++counts.used;
        break;
      case CornerState::kOutlier:
        ++counts.outliers;
        break;
      case CornerState::kUnprojectable:
        ++counts.unprojectable;
        break;
      case CornerState::kUnsupported:
        ++counts.unsupported;
        break;
    }
  }

  void estimateUncertainty(Solution& solution) const {
    const solver::SharedCovariance shared = solver::sharedCovariance(batch_, options_.num_threads);
    const UsedCorners used = usedCorners(batch_);
    const double redundancy = std::max(1.0, 2.0 * used.num_corners - shared.rank - shared.block_rank);
    solution.sigma_px = std::sqrt(used.sum_of_squares_px2 / redundancy);
    solution.sigma_whitened = std::sqrt(used.sum_of_whitened_squares / redundancy);
    solution.covariance = solution.sigma_whitened * solution.sigma_whitened *
                          baselineCovariance(solution.rig, batch_.layout(), shared.covariance);
    const auto name = [&](int i, const std::string& why) {
      const std::string entry = unknownName(solution.rig, batch_.layout(), i) + why;
      if (solution.undetermined.empty() || solution.undetermined.back() != entry) {
        solution.undetermined.push_back(entry);
      }
    };
    for (const int i : shared.undetermined) {
      name(i, "");
    }
    for (const int i : shared.at_bound) {
      name(i, " (at its bound)");
    }
  }

  const Problem& problem_;
  const SolveOptions& options_;
  BatchProblem batch_;
  std::vector<double> model_errors_px_;
  SolveStatus status_ = SolveStatus::kStalled;
  int iterations_ = 0;
};

}  // namespace

double doneShare(const SolveProgress& progress) {
  // How many iterations a stage takes shows only at its end: the usual number counts half, as many again a sixth, ...
  constexpr double kUsualIterations = 4.0;
  const double stage_share = progress.iteration / (progress.iteration + kUsualIterations);
  return (progress.stage + stage_share) / progress.num_stages;
}

Solution solve(const Problem& problem, const SolveOptions& options) { return BatchSolve(problem, options).run(); }

std::optional<Eigen::Vector2d> residual(const Rig& rig, const geometry::Rigid3& T_rig_target,
                                        const Eigen::Vector3d& p_target, int camera_index,
                                        const Eigen::Vector2d& measured_px) {
  const RigCamera& rig_camera = rig.cameras[static_cast<std::size_t>(camera_index)];
  const std::optional<Eigen::Vector2d> predicted_px =
      camera::project(rig_camera.camera, rig_camera.T_cam_rig * (T_rig_target * p_target));
  return predicted_px ? std::optional<Eigen::Vector2d>(measured_px - *predicted_px) : std::nullopt;
}

std::vector<Eigen::Vector3d> warpedPoints(const std::vector<Eigen::Vector3d>& target_points,
                                          const Eigen::Vector2d& board_warp_m) {
  WarpedBoard board(target_points);
  board.bend(board_warp_m);
  return board.points();
}

}  // namespace tartan_calib::calibration
