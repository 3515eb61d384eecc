#include <algorithm>
#include <cmath>

#include "inspect_bag/report.h"
#include "tartan_calib/median.h"
#include "tartan_calib/pipeline/warnings.h"
#include "tartan_calib/text.h"

namespace tartan_calib::apps {
namespace {

constexpr double kMsPerSecond = 1e3;
constexpr double kPercent = 100.0;

constexpr std::size_t kFewImages = 20;
/// Share of images that are missing in gaps above which a recorder or a driver did not keep up.
constexpr double kManyMissing_ratio = 0.05;
/// Receipt so long after, or before, the stamp comes from clocks that differ.
constexpr double kClockDifference_s = 1.0;
/// A board that is moved by hand moves by a pixel or more in this time.
constexpr double kLooseSync_s = 0.003;
constexpr double kFewPartners_ratio = 0.9;
constexpr double kManySaturated_ratio = 0.03;
constexpr double kDarkLevel = 90.0;  ///< white paper should be well above
constexpr double kBlurredWidth_px = 4.0;
constexpr double kManyBlurred_ratio = 0.25;
/// Share of images with a board below which much of the recording is of no use.
constexpr double kFewBoards_ratio = 0.3;

/// Collects the warnings about one topic.
class CameraWarnings {
 public:
  CameraWarnings(const CameraInspection& camera, const std::optional<target::Target>& target)
      : camera_(camera), target_(target) {}

  std::vector<std::string> collect() {
    if (!camera_.is_supported) {
      add("images of encoding " + joined(camera_.encodings) + " cannot be used: record another topic of this camera");
      return warnings_;
    }
    checkMessages();
    checkTiming();
    if (!camera_.samples.empty()) {
      checkLight();
      checkSharpness();
    }
    if (target_ && !camera_.samples.empty()) {
      checkBoard();
    }
    return warnings_;
  }

 private:
  void add(const std::string& text) { warnings_.push_back(camera_.topic + ": " + text); }

  void checkMessages() {
    if (!camera_.refusal.empty()) {
      warnings_.push_back(camera_.refusal);
    } else if (camera_.num_unreadable > 0) {
      add(format("%zu of the images that were looked at cannot be read and would be left out", camera_.num_unreadable) +
          (camera_.unreadable_reason.empty() ? "" : " (first: " + camera_.unreadable_reason + ")"));
    }
    if (camera_.num_images < kFewImages) {
      add(format("only %zu image%s: record 20 views or more, 50 to 100 for a wide lens", camera_.num_images,
                 camera_.num_images == 1 ? "" : "s"));
    }
    if (camera_.sizes.size() > 1) {
      const ImageSize size = usualSize(camera_);
      add(format("images change their size: only those of %d x %d would be used; keep the resolution fixed while recording",
                 size.first, size.second));
    }
  }

  void checkTiming() {
    const TopicTiming& timing = camera_.timing;
    if (camera_.num_images > 0 && timing.num_unstamped > 0) {
      add(format(
          "%zu images have no header stamp: times of receipt stand in, which are late by transport; let the driver set it",
          timing.num_unstamped));
    }
    if (timing.num_backwards > 0) {
      add(format("%zu stamps are earlier than the one before: images are put in order, but check the driver's clock",
                 timing.num_backwards));
    }
    if (timing.num_repeated > 0) {
      add(format("%zu images have the stamp of another one and would be left out", timing.num_repeated));
    }
    const double total = static_cast<double>(camera_.num_images + timing.num_missing);
    if (static_cast<double>(timing.num_missing) > kManyMissing_ratio * total) {
      add(format(
          "about %.0f %% of the images are missing in gaps: record to a faster disk, with rosbag record --buffsize 0, or "
          "at a lower rate",
          kPercent * static_cast<double>(timing.num_missing) / total));
    }
    if (std::abs(timing.median_delay_s) > kClockDifference_s) {
      add(
          format("stamps and times of receipt are %.1f s apart: the camera's clock is another one; it must be that of all "
                 "cameras of the rig",
                 timing.median_delay_s));
    }
  }

  template <class Predicate>
  double share(const Predicate& predicate) const {
    return static_cast<double>(std::count_if(camera_.samples.begin(), camera_.samples.end(), predicate)) /
           static_cast<double>(camera_.samples.size());
  }

  void checkLight() {
    constexpr double kHalf = 0.5;
    if (share([](const ImageQuality& s) { return s.saturated_ratio > kManySaturated_ratio; }) > kHalf) {
      add("much of the images is saturated, where white spreads over black edges: shorten the exposure or turn lamps away");
    }
    if (share([](const ImageQuality& s) { return s.bright_level < kDarkLevel; }) > kHalf) {
      add("the images are dark: more light, rather than a longer exposure, which blurs");
    }
  }

  void checkSharpness() {
    const double blurred = share([](const ImageQuality& s) { return s.edge_width_px.value_or(0.0) > kBlurredWidth_px; });
    constexpr double kNearlyAll = 0.9;
    if (blurred > kNearlyAll) {
      add(format("edges are wider than %.0f px in nearly all images: focus the lens", kBlurredWidth_px));
    } else if (blurred > kManyBlurred_ratio) {
      add(
          format("%.0f %% of the images are blurred by motion: move the board slowly, hold it still, more light and a "
                 "shorter exposure",
                 kPercent * blurred));
    }
  }

  void checkBoard() {
    const pipeline::CameraCorners& corners = camera_.corners;
    const std::optional<std::string> note = pipeline::boardNote(corners, *target_);
    if (corners.images.empty()) {
      add(
          note.value_or("no board was seen in any of the images that were looked at: check the target file, light, focus "
                        "and distance"));
    } else if (static_cast<double>(corners.images.size()) < kFewBoards_ratio * static_cast<double>(corners.num_images)) {
      add(format("the board was seen in only %zu of %zu images", corners.images.size(), corners.num_images));
    }
    const std::vector<std::string> empty = emptyThirds(corners);
    if (!corners.images.empty() && !empty.empty()) {
      add("no corners in the " + joined(empty) + " of the image: move the board there, or the lens is extrapolated");
    }
    for (const std::string& warning : pipeline::detectionWarnings(corners, 0, *target_)) {
      const std::string text = warning.substr(warning.find(": ") + 2);
      if (!corners.images.empty() || text != note) {
        add(text);
      }
    }
  }

  const CameraInspection& camera_;
  const std::optional<target::Target>& target_;
  std::vector<std::string> warnings_;
};

void addSynchronization(const std::string& topic, const Synchronization& sync, std::vector<std::string>& warnings) {
  if (sync.apart_s > 0.0) {
    warnings.push_back(topic +
                       format(": its stamps are %.1f s away from those of the other camera: their clocks differ, or they "
                              "were not recorded together",
                              sync.apart_s));
    return;
  }
  if (sync.within_half_ratio < kFewPartners_ratio) {
    warnings.push_back(topic +
                       format(": only %.0f %% of the images have a partner within half a period: images are missing, or "
                              "the cameras ran at different times",
                              kPercent * sync.within_half_ratio));
  }
  if (sync.p95_offset_s > kLooseSync_s) {
    warnings.push_back(
        topic + format(": exposures are up to %.1f ms from those of the other camera: trigger the cameras together, or "
                       "hold the board still for every view",
                       kMsPerSecond * sync.p95_offset_s));
  }
}

}  // namespace

std::vector<std::string> inspectionWarnings(const Inspection& inspection) {
  std::vector<std::string> warnings;
  for (const CameraInspection& camera : inspection.cameras) {
    const std::vector<std::string> more = CameraWarnings(camera, inspection.target).collect();
    warnings.insert(warnings.end(), more.begin(), more.end());
  }
  for (const auto& [index, sync] : inspection.synchronizations) {
    addSynchronization(inspection.cameras[index].topic, sync, warnings);
  }
  return warnings;
}

}  // namespace tartan_calib::apps
