#pragma once

#include <Eigen/Core>
#include <optional>
#include <utility>
#include <vector>

#include "observations.h"
#include "residual_block.h"
#include "robust_loss.h"
#include "tartan_calib/calibration/solve.h"
#include "tartan_calib/solver/block_problem.h"

namespace tartan_calib::calibration {

/// Where each camera's unknowns stand among the shared ones; -1 where they are held.
class SharedLayout {
 public:
  static constexpr int kHeld = -1;

  SharedLayout(const Rig& rig, const SolveOptions& options);

  int extrinsics(int camera_index) const { return extrinsics_[static_cast<std::size_t>(camera_index)]; }
  int intrinsics(int camera_index) const { return intrinsics_[static_cast<std::size_t>(camera_index)]; }
  /// True if rows of the covariance are about pupils; those of a camera whose intrinsics are held are zero.
  bool estimatesPupils() const { return estimates_pupils_; }
  int pupil(int camera_index) const { return pupils_[static_cast<std::size_t>(camera_index)]; }
  int warp() const { return warp_; }
  int size() const { return size_; }

 private:
  std::vector<int> extrinsics_;
  std::vector<int> intrinsics_;
  std::vector<int> pupils_;
  bool estimates_pupils_ = false;
  int warp_ = kHeld;
  int size_ = 0;
};

/// Reprojection errors of all views as the solver sees them: a block per view, its unknown the board's pose
/// T_rig_target <- exp(xi) T_rig_target; shared are the cameras (T_cam_rig from the left as well) and the board's warp.
class BatchProblem : public solver::BlockProblem {
 public:
  BatchProblem(const Problem& problem, const SolveOptions& options);

  const SolveState& state() const { return state_; }
  const SharedLayout& layout() const { return layout_; }
  const std::vector<ViewMeasurements>& views() const { return views_; }
  std::vector<ViewMeasurements>& views() { return views_; }

  /// One loss per camera.
  void setLosses(std::vector<RobustLoss> losses) { losses_ = std::move(losses); }
  void setPose(std::size_t view, const geometry::Rigid3& T_rig_target) { state_.T_rig_target[view] = T_rig_target; }

  /// Measured minus predicted of every corner of an image in that view; empty where the model gives it no image.
  std::vector<std::optional<Eigen::Vector2d>> errors(std::size_t view, const CameraMeasurements& image) const {
    return blockErrors(residualBlock(view, image));
  }

  int numShared() const override { return layout_.size(); }
  int numBlocks() const override { return static_cast<int>(views_.size()); }
  solver::StepLimits stepLimits() const override;
  double cost(int view) const override;
  solver::BlockTerms linearize(int view) const override;
  void move(const solver::Step& step) override;
  void save() override { saved_ = state_; }
  void restore() override;

 private:
  int numParameters(int camera_index) const;
  /// The shared unknowns that a view's images touch.
  std::vector<int> sharedOf(const ViewMeasurements& images) const;
  ResidualBlock residualBlock(std::size_t view, const CameraMeasurements& measurements) const;

  std::vector<ViewMeasurements> views_;
  SharedLayout layout_;
  WarpedBoard board_;
  std::vector<RobustLoss> losses_;
  SolveState state_;
  SolveState saved_;
};

}  // namespace tartan_calib::calibration
