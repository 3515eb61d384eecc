#pragma once

#include <Eigen/Core>
#include <vector>

#include "tartan_calib/calibration/solve.h"

namespace tartan_calib::calibration {

enum class CornerState { kUsed, kOutlier, kUnprojectable, kUnsupported };

/// A corner as the solve sees it.
struct Measurement {
  int corner_id = -1;
  Eigen::Vector2d px = Eigen::Vector2d::Zero();
  Eigen::Matrix2d cov_px2 = Eigen::Matrix2d::Identity();  ///< as detected
  /// W with W'W = inverse covariance: |W e|^2 is the squared whitened residual.
  Eigen::Matrix2d sqrt_information = Eigen::Matrix2d::Identity();
  CornerState state = CornerState::kUsed;
};

/// The corners of one camera in one view.
struct CameraMeasurements {
  int camera_index = 0;
  std::vector<Measurement> corners;
};

using ViewMeasurements = std::vector<CameraMeasurements>;

/// W with W'W = inverse of `cov`.
Eigen::Matrix2d sqrtInformation(const Eigen::Matrix2d& cov);

/// Throws InputError where the problem contradicts itself (indices out of range, numbers that are not finite, covariances
/// that are not positive definite), CalibrationError where there are no corners at all.
std::vector<ViewMeasurements> measurementsOf(const Problem& problem);

/// What is optimised.
struct SolveState {
  Rig rig;
  std::vector<geometry::Rigid3> T_rig_target;
  Eigen::Vector2d board_warp_m = Eigen::Vector2d::Zero();
};

}  // namespace tartan_calib::calibration
