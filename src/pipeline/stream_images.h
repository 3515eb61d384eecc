#pragma once

#include <algorithm>
#include <optional>
#include <utility>

#include "listen.h"
#include "ordered_workers.h"
#include "tartan_calib/pipeline/calibrate.h"
#include "tartan_calib/threads.h"

namespace tartan_calib::pipeline {

/// Images in work at a time per thread: one being worked on and one that waits, so that no thread runs dry.
constexpr std::size_t kImagesPerThread = 2;

/// Runs `work(StampedImage) -> Result` over all images of a stream on `num_threads` threads (0: all cores) and hands the
/// results to `collect(Result)` in the order of the images. Only a few images exist at a time.
template <typename Result, typename Work, typename Collect>
void streamImages(const CameraStream& stream, int num_threads, const Listener& listener, Progress progress, const Work& work,
                  const Collect& collect) {
  num_threads = numThreads(num_threads);
  const auto max_pending = kImagesPerThread * static_cast<std::size_t>(num_threads);
  const ImageSource next_image = stream.open();
  progress.done = 0;
  progress.total = stream.num_images;
  report(listener, progress);
  OrderedWorkers<Result> workers(num_threads);
  bool has_more = true;
  while (has_more || workers.numPending() > 0) {
    throwIfCancelled(listener);
    std::optional<StampedImage> image = has_more ? next_image() : std::nullopt;
    has_more = image.has_value();
    if (image) {
      workers.submit([&work, image = std::move(*image)] { return work(image); });
    }
    if (workers.numPending() >= max_pending || (!has_more && workers.numPending() > 0)) {
      collect(workers.next());
      ++progress.done;
      report(listener, progress);
    }
  }
}

}  // namespace tartan_calib::pipeline
