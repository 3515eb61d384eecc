#pragma once

#include <Eigen/Core>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "tartan_calib/calibration/rig.h"
#include "tartan_calib/geometry/rigid3.h"
#include "tartan_calib/observation/observation.h"

namespace tartan_calib::calibration {

/// Everything that the batch solve starts from.
struct Problem {
  std::vector<Eigen::Vector3d> target_points;  ///< [m], target frame, by corner id
  std::vector<observation::View> views;
  Rig rig;
  std::vector<geometry::Rigid3> T_rig_target;  ///< one per view
  /// Curvature of the board [m]: z += warp.x (1 - x^2) + warp.y (1 - y^2) with x, y in [-1, 1] over the board (as mrcal).
  Eigen::Vector2d board_warp_m = Eigen::Vector2d::Zero();
};

enum class LinearSolver {
  kAuto,    ///< the faster one for the problem's size
  kSchur,   ///< board poses eliminated, dense reduced system
  kSparse,  ///< CHOLMOD on the whole normal equations
};

/// Where a running solve stands. Stages: robust losses of falling width, then least squares around the removal of outliers.
struct SolveProgress {
  int stage = 0;  ///< from 0
  int num_stages = 0;
  int iteration = 0;    ///< within the stage
  double rms_px = 0.0;  ///< sqrt(mean |e|^2) of the corners that take part, each at most as bad as the stage's loss says
};

/// How much of the solve is done, for a bar: grows with every iteration, above 0 and below 1. Stages count alike although
/// they are not; a solve whose choice of corners stays the same early ends before its last stage.
double doneShare(const SolveProgress& progress);

struct SolveOptions {
  LinearSolver linear_solver = LinearSolver::kAuto;
  int num_threads = 0;  ///< 0: all cores. The result has the same bits for every value
  int max_iterations = 100;

  bool fix_intrinsics = false;
  bool fix_extrinsics = false;
  std::vector<int> fixed_cameras;  ///< indices of cameras of which neither intrinsics nor extrinsics change
  bool estimate_board_warp = false;
  bool estimate_pupil_shift = false;  ///< camera::PupilShift of every camera whose intrinsics are not fixed

  bool anneal_robust_loss = true;    ///< Cauchy of falling width before the final least squares
  bool only_robust = false;          ///< ends before least squares: a start for another solve, without uncertainty
  bool use_blake_zisserman = false;  ///< Kalibr's --use-blakezisserman weights in the final solve
  bool remove_outliers = true;
  double outlier_sigma = 4.0;   ///< a corner with |residual| above this many stdev of its camera, in u or v, is rejected
  int min_views_outlier = 20;   ///< with fewer views per camera the sigma rule is left out; only gross errors are removed
  bool final_filtering = true;  ///< one more pass over all views after the last solve

  /// Called after every iteration from the calling thread; returning false ends the solve with SolveStatus::kCancelled.
  std::function<bool(const SolveProgress&)> progress;
};

enum class SolveStatus {
  kConverged,
  kMaxIterations,
  kStalled,    ///< no step lowers the cost although the gradient says that there is one
  kCancelled,  ///< by the progress callback; the solution is as far as it came, without covariance
};

/// Why corners did not take part, and how many.
struct CornerCounts {
  int used = 0;
  int outliers = 0;       ///< rejected by the sigma rule
  int unprojectable = 0;  ///< the model gives the point no image; never silently cheap: counted as rejected
  int unsupported = 0;    ///< in views left with fewer than four usable corners, which determine no pose

  int rejected() const { return outliers + unprojectable + unsupported; }
};

struct Solution {
  SolveStatus status = SolveStatus::kStalled;
  int iterations = 0;
  Rig rig;
  std::vector<geometry::Rigid3> T_rig_target;  ///< one per view of the problem
  Eigen::Vector2d board_warp_m = Eigen::Vector2d::Zero();
  std::vector<observation::View> views;  ///< the problem's, with Corner::used set
  std::vector<CornerCounts> counts;      ///< by camera
  std::vector<int> unsolved_views;       ///< without a used corner; these keep their start pose

  double sigma_px = 0.0;  ///< stdev of a residual component: sqrt(sum of squares / (measurements - parameters))
  /// By camera: stdev that the lens model's own error adds to the corners', estimated so that residuals over both are 1.
  std::vector<double> model_errors_px;
  double sigma_whitened = 0.0;  ///< the same of residuals over Corner::cov_px2 and the model errors

  /// Covariance of [for each camera >= 1 its baseline T_i_(i-1): rotation 3 (rad, R <- exp(phi) R), translation 3 (m); for
  /// each camera its parameters in Kalibr's order; board warp 2 where estimated; each camera its pupil 2 where estimated],
  /// scaled by sigma_whitened^2. Fixed parameters and those at their bound have zero rows. Directions that the views do not
  /// determine are left out (pseudo-inverse); `undetermined` names the parameters that they and the bounds concern.
  Eigen::MatrixXd covariance;
  std::vector<std::string> undetermined;
};

/// Index of the first covariance row of camera i's parameters, and of its baseline (i >= 1).
int intrinsicsRow(const Rig& rig, int camera_index);
int baselineRow(int camera_index);

/// Minimises the reprojection error over all views at once. Throws CalibrationError where nothing can be solved (no
/// corners).
Solution solve(const Problem& problem, const SolveOptions& options);

/// Measured minus predicted position of one corner in a solution [px]; empty where the model gives it no image.
std::optional<Eigen::Vector2d> residual(const Rig& rig, const geometry::Rigid3& T_rig_target,
                                        const Eigen::Vector3d& p_target, int camera_index,
                                        const Eigen::Vector2d& measured_px);

/// The target's points with the curvature applied.
std::vector<Eigen::Vector3d> warpedPoints(const std::vector<Eigen::Vector3d>& target_points,
                                          const Eigen::Vector2d& board_warp_m);

}  // namespace tartan_calib::calibration
