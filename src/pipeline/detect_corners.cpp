#include <algorithm>
#include <utility>

#include "stream_images.h"
#include "tartan_calib/pipeline/calibrate.h"

namespace tartan_calib::pipeline {
namespace {

using observation::CameraView;

struct ImageSize {
  int width = 0;
  int height = 0;

  bool operator==(const ImageSize& other) const { return width == other.width && height == other.height; }
};

/// What one image gave.
struct ImageResult {
  std::int64_t stamp_ns = 0;
  ImageSize size;
  detection::Detection detection;
  std::optional<std::string> unreadable_reason;
};

ImageResult detectImage(const detection::TargetDetector& detector, const StampedImage& image) {
  ImageResult result;
  result.stamp_ns = image.stamp_ns;
  try {
    const cv::Mat gray = image.load();
    result.size = {gray.cols, gray.rows};
    result.detection = detector.detect(gray);
  } catch (const InputError& error) {
    result.unreadable_reason = error.what();
  }
  return result;
}

/// Collects the images in order. The camera's size is the one that most images have, so all are kept until the end.
class Collector {
 public:
  void add(ImageResult result) {
    ++corners_.num_images;
    if (result.unreadable_reason) {
      if (corners_.num_unreadable++ == 0) {
        corners_.unreadable_reason = *result.unreadable_reason;
      }
      return;
    }
    if (last_stamp_ns_ == result.stamp_ns) {
      ++corners_.num_same_stamp;
      return;
    }
    last_stamp_ns_ = result.stamp_ns;
    countSize(result.size);
    results_.push_back(std::move(result));
  }

  CameraCorners finish(int camera_index) {
    const auto fewer = [](const SizeCount& a, const SizeCount& b) { return a.second < b.second; };
    const auto most = std::max_element(sizes_.begin(), sizes_.end(), fewer);  // the first one among equals
    if (most != sizes_.end()) {
      corners_.width = most->first.width;
      corners_.height = most->first.height;
    }
    for (ImageResult& result : results_) {
      if (result.size == most->first) {
        keep(std::move(result), camera_index);
      } else {
        ++corners_.num_other_size;
      }
    }
    return std::move(corners_);
  }

 private:
  using SizeCount = std::pair<ImageSize, std::size_t>;

  void countSize(const ImageSize& size) {
    const auto found = std::find_if(sizes_.begin(), sizes_.end(), [&size](const SizeCount& s) { return s.first == size; });
    if (found == sizes_.end()) {
      sizes_.emplace_back(size, 1);
    } else {
      ++found->second;
    }
  }

  void keep(ImageResult result, int camera_index) {
    corners_.counts += result.detection.counts;
    if (!result.detection.corners.empty()) {
      corners_.images.push_back(CameraView{camera_index, result.stamp_ns, std::move(result.detection.corners)});
    }
  }

  CameraCorners corners_;
  std::optional<std::int64_t> last_stamp_ns_;
  std::vector<SizeCount> sizes_;
  std::vector<ImageResult> results_;
};

}  // namespace

CameraCorners detectCorners(const CameraStream& stream, int camera_index, const target::Target& target,
                            const CalibrateOptions& options, const Listener& listener) {
  const detection::TargetDetector detector(target, options.detector);
  Collector collector;
  streamImages<ImageResult>(
      stream, options.num_threads, listener, {Stage::kDetect, camera_index, 0, 0},
      [&detector](const StampedImage& image) { return detectImage(detector, image); },
      [&collector](ImageResult result) { collector.add(std::move(result)); });
  CameraCorners corners = collector.finish(camera_index);
  corners.topic = stream.topic;
  return corners;
}

}  // namespace tartan_calib::pipeline
