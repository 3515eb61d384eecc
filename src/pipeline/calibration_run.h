#pragma once

#include <chrono>
#include <vector>

#include "rejected_corners.h"
#include "search_history.h"
#include "tartan_calib/pipeline/calibrate.h"

namespace tartan_calib::pipeline {

/// One calibration from corners: cameras are added one by one, each started alone, then all are solved together.
class CalibrationRun {
 public:
  /// Throws InputError where the options do not fit that number of cameras.
  CalibrationRun(std::size_t num_cameras, const target::Target& target, const CalibrateOptions& options,
                 const Listener& listener);

  /// Starts the next camera. `seconds`: what its detection took.
  void addCamera(const CameraCorners& corners, std::optional<double> seconds);

  /// Solves all cameras together from their starts.
  void solveTogether();

  /// Goes through the images again with the solved model, and solves again. False once nothing improves any more, and where
  /// that led to no calibration: then the one before stays.
  bool runRound(const std::vector<CameraStream>& streams);

  /// Statistics of the last solve, and everything else that the result tells.
  CalibrationResult finish();

  /// The same as it stands now.
  CalibrationResult current() const;

 private:
  using Clock = std::chrono::steady_clock;

  void warn(const std::string& text);
  void begin(Stage stage, int camera_index = -1);
  void end();
  std::vector<observation::CameraView> usableImages(const CameraCorners& corners, int camera_index) const;
  calibration::Problem startRig();
  calibration::SolveOptions solveOptions() const;  ///< of a solve that tells the stage's iterations and can be cancelled
  void solve(const calibration::Problem& problem);
  void solveAgain(RoundSummary& summary);  ///< from the last solution, of corners that a round has changed
  std::vector<CameraCorners> recoverAll(const std::vector<CameraStream>& streams);
  void describe(CalibrationResult& result) const;

  const target::Target& target_;
  const CalibrateOptions& options_;
  const Listener& listener_;
  const std::vector<Eigen::Vector3d> target_points_;

  std::vector<CameraCorners> corners_;                        ///< by camera, all images
  std::vector<std::vector<observation::CameraView>> usable_;  ///< by camera, those that take part
  std::vector<camera::Camera> started_;
  std::optional<calibration::Rig> known_rig_;  ///< extrinsics to start from
  std::vector<SearchHistory> searched_;        ///< by camera
  RejectedCorners rejected_;                   ///< by the rounds
  CalibrationResult result_;
  Progress stage_;
  Clock::time_point stage_begin_;
};

}  // namespace tartan_calib::pipeline
