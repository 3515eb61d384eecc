#include "tartan_calib/pipeline/calibrate.h"

#include <algorithm>
#include <chrono>

#include "calibration_run.h"
#include "check_options.h"

namespace tartan_calib::pipeline {
namespace {

void throwIfUnreadable(const CameraStream& stream, const CameraCorners& corners) {
  if (corners.num_images == 0) {
    throw InputError(stream.topic + ": there are no images");
  }
  if (corners.num_unreadable == corners.num_images) {
    throw InputError(stream.topic + ": no image can be read: " + corners.unreadable_reason);
  }
}

}  // namespace

std::string stageName(Stage stage) {
  switch (stage) {
    case Stage::kDetect:
      return "detect";
    case Stage::kStartCamera:
      return "start camera";
    case Stage::kStartRig:
      return "start rig";
    case Stage::kSolve:
      return "solve";
    case Stage::kRecover:
      return "recover";
    case Stage::kStatistics:
      return "statistics";
  }
  return "";
}

CalibrationResult calibrate(const std::vector<CameraStream>& streams, const target::Target& target,
                            const CalibrateOptions& options, const Listener& listener) {
  CalibrationRun run(streams.size(), target, options, listener);
  if (options.known_rig) {
    checkFirstImages(streams, *options.known_rig);
  }
  for (std::size_t i = 0; i < streams.size(); ++i) {
    const int index = static_cast<int>(i);
    const auto begin = std::chrono::steady_clock::now();
    const CameraCorners corners = detectCorners(streams[i], index, target, options, listener);
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - begin;
    throwIfUnreadable(streams[i], corners);
    if (listener.camera_detected) {
      listener.camera_detected(index, corners);
    }
    run.addCamera(corners, seconds.count());
  }
  run.solveTogether();
  if (listener.detection_solved) {
    listener.detection_solved(run.current());
  }
  const int max_rounds = std::max(options.max_rounds, options.projections.empty() ? 0 : 1);
  for (int round = 0; round < max_rounds && run.runRound(streams); ++round) {
  }
  return run.finish();
}

CalibrationResult calibrateCorners(const std::vector<CameraCorners>& cameras, const target::Target& target,
                                   const CalibrateOptions& options, const Listener& listener) {
  CalibrationRun run(cameras.size(), target, options, listener);
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    if (listener.camera_detected) {
      listener.camera_detected(static_cast<int>(i), cameras[i]);
    }
    run.addCamera(cameras[i], std::nullopt);
  }
  run.solveTogether();
  if (listener.detection_solved) {
    listener.detection_solved(run.current());
  }
  return run.finish();
}

}  // namespace tartan_calib::pipeline
