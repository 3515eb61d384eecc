#include "rejected_corners.h"

#include <algorithm>

namespace tartan_calib::pipeline {
namespace {

using observation::CameraView;
using observation::Corner;

void add(const std::map<int, Corner>& rejected, CameraView& image) {
  for (const auto& [id, corner] : rejected) {
    image.corners.push_back(corner);
  }
  std::sort(image.corners.begin(), image.corners.end(),
            [](const Corner& a, const Corner& b) { return a.corner_id < b.corner_id; });
}

}  // namespace

void RejectedCorners::update(const std::vector<CameraCorners>& before, const std::vector<CameraCorners>& after) {
  for (std::size_t camera = 0; camera < before.size(); ++camera) {
    for (const CameraView& image : before[camera].images) {
      for (Corner corner : image.corners) {
        corner.used = false;
        images_[{static_cast<int>(camera), image.stamp_ns}][corner.corner_id] = corner;
      }
    }
  }
  for (std::size_t camera = 0; camera < after.size(); ++camera) {
    for (const CameraView& image : after[camera].images) {
      const auto rejected = images_.find({static_cast<int>(camera), image.stamp_ns});
      for (const Corner& corner : image.corners) {
        if (rejected != images_.end()) {
          rejected->second.erase(corner.corner_id);
        }
      }
    }
  }
}

void RejectedCorners::addTo(CalibrationResult& result) const {
  std::map<ImageKey, CameraView*> images;
  for (observation::View& view : result.solution.views) {
    for (CameraView& image : view.cameras) {
      images[{image.camera_index, image.stamp_ns}] = &image;
    }
  }
  for (CameraView& image : result.unused_images) {
    images[{image.camera_index, image.stamp_ns}] = &image;
  }
  std::vector<CameraView> gone;
  for (const auto& [key, corners] : images_) {
    if (corners.empty()) {
      continue;
    }
    const auto [camera_index, stamp_ns] = key;
    result.solution.counts[static_cast<std::size_t>(camera_index)].outliers += static_cast<int>(corners.size());
    const auto image = images.find(key);
    if (image == images.end()) {
      gone.push_back({camera_index, stamp_ns, {}});
    }
    add(corners, image == images.end() ? gone.back() : *image->second);
  }
  result.unused_images.insert(result.unused_images.end(), gone.begin(), gone.end());
}

}  // namespace tartan_calib::pipeline
