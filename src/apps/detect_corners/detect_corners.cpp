#include "detect_corners/detect_corners.h"

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>

#include "common/detection.h"
#include "common/interrupt.h"
#include "common/output.h"
#include "common/program.h"
#include "common/progress_bar.h"
#include "common/recording.h"
#include "detect_corners/corner_pictures.h"
#include "tartan_calib/io/corners_csv.h"
#include "tartan_calib/pipeline/warnings.h"
#include "tartan_calib/text.h"

namespace tartan_calib::apps {
namespace {

/// `90, 30.0 in an image with board (least 10, median 20, most 60)`; there are images.
std::string perImageText(const std::vector<observation::CameraView>& images) {
  std::vector<std::size_t> counts;
  std::size_t total = 0;
  for (const observation::CameraView& image : images) {
    counts.push_back(image.corners.size());
    total += image.corners.size();
  }
  std::sort(counts.begin(), counts.end());
  return format("%zu, %.1f in an image with board (least %zu, median %zu, most %zu)", total,
                static_cast<double>(total) / static_cast<double>(counts.size()), counts.front(), counts[counts.size() / 2],
                counts.back());
}

std::string tagsText(const detection::DetectionCounts& counts) {
  return format(
      "%d; dropped: %d seen twice in an image, %d that are not on the board, %d mirrored; %d with the other border",
      counts.tags, counts.duplicate_tags, counts.foreign_tags, counts.mirrored_tags, counts.other_border_tags);
}

void throwIfNothing(const std::vector<pipeline::CameraCorners>& cameras, const target::Target& target) {
  std::string reasons;
  for (const pipeline::CameraCorners& camera : cameras) {
    if (!camera.images.empty()) {
      return;
    }
    if (camera.num_images > 0 && camera.num_unreadable == camera.num_images) {
      throw InputError(camera.topic + ": no image can be read: " + camera.unreadable_reason);
    }
    reasons +=
        (reasons.empty() ? "" : "; ") + camera.topic + ": none of its " + std::to_string(camera.num_images) +
        " images shows the target: " + pipeline::boardNote(camera, target).value_or("check target file, focus and exposure");
  }
  throw CalibrationError(reasons);
}

void drawAll(const std::vector<pipeline::CameraStream>& streams, const std::vector<pipeline::CameraCorners>& cameras,
             const target::Target& target, const DetectOptions& options, ProgressBar& bar) {
  const auto max_pictures = static_cast<std::size_t>(options.max_pictures);
  for (std::size_t i = 0; i < streams.size(); ++i) {
    const std::size_t share = max_pictures * (i + 1) / streams.size() - max_pictures * i / streams.size();
    const std::string folder = (std::filesystem::path(options.picture_folder) / cameraName(i)).string();
    const std::size_t num_drawn = writeCornerPictures(streams[i], cameras[i].images, target, folder, share,
                                                      [&bar, i](std::size_t done, std::size_t total) {
                                                        bar.show(done, total);
                                                        setItemsDone(done, total, "pictures of " + cameraName(i));
                                                      });
    bar.clear();
    std::printf("%zu pictures written to %s\n", num_drawn, folder.c_str());
  }
}

}  // namespace

std::string detectionText(const pipeline::CameraCorners& corners, int camera_index, const target::Target& target) {
  constexpr double kPercent = 100.0;
  std::string text =
      format("%s (%s): %dx%d\n", cameraName(camera_index).c_str(), corners.topic.c_str(), corners.width, corners.height);
  const auto num_images = static_cast<double>(std::max<std::size_t>(1, corners.num_images));
  text += format("  images:  %zu, %zu with board (%.1f %%)\n", corners.num_images, corners.images.size(),
                 kPercent * static_cast<double>(corners.images.size()) / num_images);
  text += "  corners: " + (corners.images.empty() ? "none" : perImageText(corners.images)) +
          format(", of %d\n", target::numCorners(target));
  if (std::holds_alternative<target::AprilGrid>(target)) {
    text += "  tags:    " + tagsText(corners.counts) + "\n";
  }
  return text;
}

void detectCorners(const DetectOptions& options) {
  checkIsThere(options.recording);
  checkFolderOf(options.output);
  const target::Target target = openTarget(options.target_file, printWarning);
  const std::vector<pipeline::CameraStream> streams =
      openRecording(options.recording, options.topics, options.selection, printWarning);
  ProgressBar bar(isatty(STDOUT_FILENO) != 0);
  pipeline::CalibrateOptions detect;
  detect.detector.min_border_distance_px = options.min_border_distance_px;
  detect.num_threads = options.num_threads;
  const auto tell = [&target](int index, const pipeline::CameraCorners& corners) {
    std::printf("%s", detectionText(corners, index, target).c_str());
  };
  const std::vector<pipeline::CameraCorners> cameras = detectAll(streams, target, detect, bar, tell);
  throwIfNothing(cameras, target);
  {
    const UninterruptedSection file_is_written_whole;
    io::saveCorners(options.output, cameras);
    setFinishedWork(options.output + (options.picture_folder.empty() ? " is" : " and the pictures so far are") + " written");
  }
  std::printf("Corners written to %s\n", options.output.c_str());
  if (!options.picture_folder.empty()) {
    drawAll(streams, cameras, target, options, bar);
  }
}

}  // namespace tartan_calib::apps
