#include "rejected_corners.h"

#include <algorithm>
#include <iterator>

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

bool has(const CameraView& image, int corner_id) {
  const auto at = std::lower_bound(image.corners.begin(), image.corners.end(), corner_id,
                                   [](const Corner& corner, int id) { return corner.corner_id < id; });
  return at != image.corners.end() && at->corner_id == corner_id;
}

}  // namespace

void RejectedCorners::update(const std::vector<CameraCorners>& before, const std::vector<CameraCorners>& after) {
  std::map<ImageKey, const CameraView*> kept;
  for (std::size_t camera = 0; camera < after.size(); ++camera) {
    for (const CameraView& image : after[camera].images) {
      kept[{static_cast<int>(camera), image.stamp_ns}] = &image;
    }
  }
  for (std::size_t camera = 0; camera < before.size(); ++camera) {
    for (const CameraView& image : before[camera].images) {
      const ImageKey key(static_cast<int>(camera), image.stamp_ns);
      const auto now = kept.find(key);
      for (Corner corner : image.corners) {
        if (now == kept.end() || !has(*now->second, corner.corner_id)) {
          corner.used = false;
          images_[key][corner.corner_id] = corner;
        }
      }
    }
  }
  for (auto& [key, corners] : images_) {
    const auto now = kept.find(key);
    for (auto corner = corners.begin(); corner != corners.end();) {
      const bool is_back = now != kept.end() && has(*now->second, corner->first);
      corner = is_back ? corners.erase(corner) : std::next(corner);
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
