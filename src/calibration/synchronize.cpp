#include "tartan_calib/calibration/synchronize.h"

#include <algorithm>
#include <cstddef>
#include <tuple>
#include <utility>

namespace tartan_calib::calibration {
namespace {

using observation::CameraView;
using observation::View;

/// A run of images, neighbours in time, that becomes a view. By increasing stamp.
struct Group {
  std::vector<const CameraView*> images;
};

std::int64_t viewStamp(const std::vector<const CameraView*>& images) {
  return (*std::min_element(images.begin(), images.end(),
                            [](const CameraView* a, const CameraView* b) { return a->camera_index < b->camera_index; }))
      ->stamp_ns;
}

bool haveCameraInCommon(const Group& a, const Group& b) {
  return std::any_of(a.images.begin(), a.images.end(), [&b](const CameraView* image) {
    return std::any_of(b.images.begin(), b.images.end(),
                       [image](const CameraView* other) { return other->camera_index == image->camera_index; });
  });
}

bool canJoin(const Group& earlier, const Group& later, std::int64_t tolerance_ns) {
  if (haveCameraInCommon(earlier, later)) {
    return false;
  }
  std::vector<const CameraView*> joined = earlier.images;
  joined.insert(joined.end(), later.images.begin(), later.images.end());
  const std::int64_t stamp_ns = viewStamp(joined);
  return stamp_ns - joined.front()->stamp_ns <= tolerance_ns && joined.back()->stamp_ns - stamp_ns <= tolerance_ns;
}

/// All images by stamp, then camera.
std::vector<const CameraView*> sortedImages(const std::vector<std::vector<CameraView>>& cameras) {
  std::vector<const CameraView*> images;
  for (const std::vector<CameraView>& camera : cameras) {
    for (const CameraView& image : camera) {
      images.push_back(&image);
    }
  }
  std::sort(images.begin(), images.end(), [](const CameraView* a, const CameraView* b) {
    return std::tie(a->stamp_ns, a->camera_index) < std::tie(b->stamp_ns, b->camera_index);
  });
  return images;
}

/// Positions i of all neighbours (i, i + 1), nearest first.
std::vector<std::size_t> gapsBySize(const std::vector<const CameraView*>& images) {
  std::vector<std::pair<std::int64_t, std::size_t>> gaps;
  for (std::size_t i = 0; i + 1 < images.size(); ++i) {
    gaps.emplace_back(images[i + 1]->stamp_ns - images[i]->stamp_ns, i);
  }
  std::sort(gaps.begin(), gaps.end());
  std::vector<std::size_t> positions;
  for (const auto& [gap_ns, position] : gaps) {
    positions.push_back(position);
  }
  return positions;
}

View makeView(const Group& group) {
  View view;
  view.stamp_ns = viewStamp(group.images);
  for (const CameraView* image : group.images) {
    view.cameras.push_back(*image);
  }
  std::sort(view.cameras.begin(), view.cameras.end(),
            [](const CameraView& a, const CameraView& b) { return a.camera_index < b.camera_index; });
  return view;
}

}  // namespace

std::vector<View> synchronize(const std::vector<std::vector<CameraView>>& cameras, std::int64_t tolerance_ns) {
  const std::vector<const CameraView*> images = sortedImages(cameras);
  // Groups are runs of `images`; only the entries at a run's two ends are kept up to date.
  std::vector<Group> groups(images.size());
  std::vector<std::size_t> first(images.size());  // of the run that ends here
  std::vector<std::size_t> last(images.size());   // of the run that begins here
  for (std::size_t i = 0; i < images.size(); ++i) {
    groups[i].images = {images[i]};
    first[i] = last[i] = i;
  }
  for (const std::size_t gap : gapsBySize(images)) {
    Group& earlier = groups[first[gap]];
    Group& later = groups[gap + 1];
    if (canJoin(earlier, later, tolerance_ns)) {
      earlier.images.insert(earlier.images.end(), later.images.begin(), later.images.end());
      later.images.clear();
      const std::size_t begin = first[gap];
      const std::size_t end = last[gap + 1];
      last[begin] = end;
      first[end] = begin;
    }
  }
  std::vector<View> views;
  for (const Group& group : groups) {
    if (!group.images.empty()) {
      views.push_back(makeView(group));
    }
  }
  std::sort(views.begin(), views.end(), [](const View& a, const View& b) { return a.stamp_ns < b.stamp_ns; });
  return views;
}

}  // namespace tartan_calib::calibration
