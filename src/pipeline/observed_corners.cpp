#include <algorithm>

#include "tartan_calib/pipeline/calibrate.h"

namespace tartan_calib::pipeline {

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

}  // namespace tartan_calib::pipeline
