#include "tartan_calib/pipeline/calibrate.h"

#include <algorithm>
#include <chrono>
#include <set>

#include "calibration_run.h"

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

int minTags(const target::AprilGrid& grid) {
  return std::min(std::max(grid.tag_rows, grid.tag_cols) + 1, target::numTags(grid));
}

int countTags(const target::AprilGrid& grid, const std::vector<observation::Corner>& corners) {
  const int lattice_cols = 2 * grid.tag_cols;
  std::set<int> tags;
  for (const observation::Corner& corner : corners) {
    const int row = corner.corner_id / lattice_cols / 2;
    const int col = corner.corner_id % lattice_cols / 2;
    tags.insert(row * grid.tag_cols + col);
  }
  return static_cast<int>(tags.size());
}

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
    case Stage::kStatistics:
      return "statistics";
  }
  return "";
}

std::vector<CameraCorners> observedCorners(const CalibrationResult& result) {
  std::vector<CameraCorners> cameras;
  for (std::size_t i = 0; i < result.cameras.size(); ++i) {
    CameraCorners corners;
    corners.topic = result.cameras[i].topic;
    corners.width = result.solution.rig.cameras[i].camera.width;
    corners.height = result.solution.rig.cameras[i].camera.height;
    corners.num_images = result.cameras[i].num_images;
    corners.counts = result.cameras[i].counts;
    cameras.push_back(corners);
  }
  for (const observation::View& view : result.solution.views) {
    for (const observation::CameraView& image : view.cameras) {
      cameras[static_cast<std::size_t>(image.camera_index)].images.push_back(image);
    }
  }
  for (const observation::CameraView& image : result.unused_images) {
    cameras[static_cast<std::size_t>(image.camera_index)].images.push_back(image);
  }
  for (CameraCorners& corners : cameras) {
    const auto by_stamp = [](const auto& a, const auto& b) { return a.stamp_ns < b.stamp_ns; };
    std::sort(corners.images.begin(), corners.images.end(), by_stamp);
  }
  return cameras;
}

CalibrationResult calibrate(const std::vector<CameraStream>& streams, const target::Target& target,
                            const CalibrateOptions& options, const Listener& listener) {
  CalibrationRun run(streams.size(), target, options, listener);
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
  return run.finish();
}

}  // namespace tartan_calib::pipeline
