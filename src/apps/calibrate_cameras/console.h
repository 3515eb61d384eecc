#pragma once

#include <cstddef>

#include "calibrate_cameras/inputs.h"
#include "calibrate_cameras/outputs.h"
#include "calibrate_cameras/report.h"
#include "common/progress_bar.h"
#include "tartan_calib/pipeline/calibrate.h"

namespace tartan_calib::apps {

/// Tells on standard output what happens, in Kalibr's words where scripts look for them.
class Console {
 public:
  explicit Console(const Inputs& inputs);

  /// Valid while the console is.
  pipeline::Listener listener();

  void printResult(const pipeline::CalibrationResult& result);
  void printFiles(const OutputFiles& files);

  /// Those of `--export-poses` and `--export-corners`, of which Kalibr tells last.
  void printExports(const OutputFiles& files);
  /// Of the report; where `total` is not known yet, for how long the step has run.
  void showStep(const std::string& step, std::size_t done, std::size_t total);
  void printReport(const ReportFiles& report);
  void printTimes(const pipeline::CalibrationResult& result);

 private:
  void noteStep(const pipeline::Progress& progress);
  void onProgress(const pipeline::Progress& progress);
  void onDetected(int camera_index, const pipeline::CameraCorners& corners);
  void onStarted(const camera::Camera& camera);
  void onRigStarted(const calibration::Problem& problem);
  void onRoundFinished(const pipeline::RoundSummary& round);
  void printCameraHeader(int camera_index, std::size_t num_images);

  const Inputs& inputs_;
  ProgressBar bar_;
  std::string step_;  ///< that the bar is about
  int round_ = 0;
  int num_rounds_finished_ = 0;
};

}  // namespace tartan_calib::apps
