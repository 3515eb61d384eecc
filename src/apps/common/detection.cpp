#include "common/detection.h"

#include <cstdio>

#include "common/interrupt.h"
#include "common/program.h"
#include "tartan_calib/pipeline/warnings.h"

namespace tartan_calib::apps {

std::vector<pipeline::CameraCorners> detectAll(
    const std::vector<pipeline::CameraStream>& streams, const target::Target& target,
    const pipeline::CalibrateOptions& options, ProgressBar& bar,
    const std::function<void(int camera_index, const pipeline::CameraCorners&)>& detected) {
  pipeline::Listener listener;
  listener.progress = [&](const pipeline::Progress& progress) {
    bar.show(progress.done, progress.total);
    setItemsDone(progress.done, progress.total,
                 "images of " + streams[static_cast<std::size_t>(progress.camera_index)].topic);
  };
  std::vector<pipeline::CameraCorners> cameras;
  for (const pipeline::CameraStream& stream : streams) {
    const int index = static_cast<int>(cameras.size());
    setItemsDone(0, stream.num_images, "images of " + stream.topic);
    std::printf("Looking for the board in %zu images of %s\n", stream.num_images, stream.topic.c_str());
    std::fflush(stdout);
    cameras.push_back(pipeline::detectCorners(stream, index, target, options, listener));
    bar.clear();
    for (const std::string& warning : pipeline::detectionWarnings(cameras.back(), index, target)) {
      printWarning(warning);
    }
    if (detected) {
      detected(index, cameras.back());
    }
    std::fflush(stdout);
  }
  return cameras;
}

}  // namespace tartan_calib::apps
