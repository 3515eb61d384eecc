#include "inspect_bag/report.h"

#include <algorithm>
#include <cmath>

#include "tartan_calib/median.h"
#include "tartan_calib/pipeline/warnings.h"
#include "tartan_calib/text.h"

namespace tartan_calib::apps {
namespace {

constexpr double kMsPerSecond = 1e3;
constexpr double kPercent = 100.0;
constexpr double kSecondsPerNs = 1e-9;

std::string line(const std::string& name, const std::string& text) { return format("  %-11s", name.c_str()) + text + '\n'; }

std::string item(const std::string& text) { return "  " + text + '\n'; }

/// Upper median of a number of every sample.
template <class Value>
double medianOf(const std::vector<ImageQuality>& samples, const Value& value) {
  std::vector<double> values;
  values.reserve(samples.size());
  for (const ImageQuality& sample : samples) {
    values.push_back(value(sample));
  }
  return upperMedian(values);
}

std::string kindText(const CameraInspection& camera) {
  std::string text = camera.type;
  for (const std::string& encoding : camera.encodings) {
    text += encoding.empty() ? "" : ", " + encoding;
  }
  for (const auto& [size, count] : camera.sizes) {
    text += format(", %d x %d", size.first, size.second) + (camera.sizes.size() > 1 ? format(" (%zu)", count) : "");
  }
  return text;
}

std::string amountText(const CameraInspection& camera) {
  const TopicTiming& timing = camera.timing;
  std::string text = format("%zu in %.1f s", camera.num_images, timing.duration_s);
  if (timing.is_regular) {
    text += format(", %.2f Hz, 95 %% of the periods within %.1f ms", 1.0 / timing.period_s, kMsPerSecond * timing.jitter_s);
  } else if (timing.period_s > 0.0) {
    text += format(", at irregular times, %.2f s apart (median)", timing.period_s);
  }
  return text;
}

std::string gapText(const TopicTiming& timing) {
  return timing.num_gaps == 0 ? "none"
                              : format("%zu with about %zu missing images, the longest of %.2f s after %.1f s",
                                       timing.num_gaps, timing.num_missing, timing.longest_gap_s, timing.longest_gap_at_s);
}

std::string stampText(const CameraInspection& camera) {
  const TopicTiming& timing = camera.timing;
  if (timing.num_unstamped == camera.num_images) {
    return "none in the headers; the times of receipt are used";
  }
  std::string text = timing.num_backwards == 0 ? "in order" : format("%zu go back in time", timing.num_backwards);
  text += timing.num_repeated == 0 ? "" : format(", %zu repeated", timing.num_repeated);
  text += timing.num_unstamped == 0 ? "" : format(", %zu missing", timing.num_unstamped);
  const bool is_recorded_live = timing.min_delay_s != 0.0 || timing.max_delay_s != 0.0;
  return text + (is_recorded_live ? format("; received %.1f ms later (%.1f to %.1f)", kMsPerSecond * timing.median_delay_s,
                                           kMsPerSecond * timing.min_delay_s, kMsPerSecond * timing.max_delay_s)
                                  : "");
}

std::string lightText(const std::vector<ImageQuality>& samples) {
  constexpr double kWhite = 255.0;
  const double bright_level = medianOf(samples, [](const ImageQuality& s) { return s.bright_level; });
  return format("mean %.0f of 255, brightest 1 %% %s; %.1f %% saturated, %.1f %% black",
                medianOf(samples, [](const ImageQuality& s) { return s.mean_level; }),
                bright_level < kWhite ? format("from %.0f on", bright_level).c_str() : "at 255",
                kPercent * medianOf(samples, [](const ImageQuality& s) { return s.saturated_ratio; }),
                kPercent * medianOf(samples, [](const ImageQuality& s) { return s.black_ratio; }));
}

std::string sharpnessText(const std::vector<ImageQuality>& samples) {
  std::vector<double> widths_px;
  for (const ImageQuality& sample : samples) {
    if (sample.edge_width_px) {
      widths_px.push_back(*sample.edge_width_px);
    }
  }
  if (widths_px.empty()) {
    return "no edges to judge by";
  }
  std::sort(widths_px.begin(), widths_px.end());
  return format("edges %.1f px wide (best %.1f, worst %.1f); 2 is sharp, above 4 is blurred", upperMedian(widths_px),
                widths_px.front(), widths_px.back());
}

std::string boardText(const pipeline::CameraCorners& corners, const target::Target& target) {
  if (corners.images.empty()) {
    const std::optional<std::string> note = pipeline::boardNote(corners, target);
    return format("not seen in any of %zu images", corners.num_images) + (note ? ": " + *note : "");
  }
  std::vector<double> counts;
  for (const observation::CameraView& image : corners.images) {
    counts.push_back(static_cast<double>(image.corners.size()));
  }
  return format("in %zu of %zu images, %.0f corners in the median one; where over the image:", corners.images.size(),
                corners.num_images, upperMedian(counts));
}

std::string cameraText(const CameraInspection& camera, const std::optional<target::Target>& target) {
  std::string text = '\n' + camera.topic + "  (" + kindText(camera) + ")\n";
  if (camera.num_images == 0) {
    return text + line("images", "none");
  }
  text += line("images", amountText(camera)) + (camera.timing.is_regular ? line("gaps", gapText(camera.timing)) : "") +
          line("stamps", stampText(camera));
  if (camera.samples.empty()) {
    return text + line("left out", camera.left_out);
  }
  text += line("light", lightText(camera.samples)) + line("sharpness", sharpnessText(camera.samples));
  if (target) {
    text += line("board", boardText(camera.corners, *target));
    if (!camera.corners.images.empty()) {
      for (const std::string& row : coveragePicture(camera.corners)) {
        text += line("", row);
      }
    }
  }
  return text + (camera.isUsable() ? "" : line("left out", camera.left_out));
}

std::string synchronizationText(const Inspection& inspection) {
  std::string text;
  for (const auto& [index, sync] : inspection.synchronizations) {
    text += item(inspection.cameras[index].topic +
                 format(": %+.1f ms (median), 95 %% within %.1f ms, at most %.1f ms; %.0f %% have a partner within half "
                        "a period",
                        kMsPerSecond * sync.median_offset_s, kMsPerSecond * sync.p95_offset_s,
                        kMsPerSecond * sync.max_offset_s, kPercent * sync.within_half_ratio));
  }
  if (text.empty()) {
    return text;
  }
  const auto first = std::find_if(inspection.cameras.begin(), inspection.cameras.end(),
                                  [](const CameraInspection& camera) { return camera.isUsable(); });
  return "\nStamps against the nearest of " + first->topic + '\n' + text;
}

std::string otherText(const Inspection& inspection) {
  std::string text = inspection.other_topics.empty() ? "" : "\nOther topics\n";
  for (const ros::OtherTopic& topic : inspection.other_topics) {
    const double duration_s = kSecondsPerNs * static_cast<double>(topic.last_ns - topic.first_ns);
    text += item(topic.topic + "  (" + topic.type + ") " + format("%zu messages", topic.num_messages) +
                 (duration_s > 0.0 ? format(", %.1f Hz", static_cast<double>(topic.num_messages - 1) / duration_s) : ""));
  }
  return text;
}

/// As a shell takes it.
std::string quoted(const std::string& word) {
  constexpr const char* kPlain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_./-+=:,@%";
  if (!word.empty() && word.find_first_not_of(kPlain) == std::string::npos) {
    return word;
  }
  std::string text = "'";
  for (const char letter : word) {
    text += letter == '\'' ? std::string("'\\''") : std::string(1, letter);
  }
  return text + "'";
}

/// `--bag-freq` that leaves as many images as are of use; empty where there are no more. Its period is no multiple of the
/// images', where a little jitter would decide what is kept.
std::string rateFlag(const Inspection& inspection) {
  constexpr double kEnoughImages = 300.0;
  const CameraInspection* longest = nullptr;
  for (const CameraInspection& camera : inspection.cameras) {
    if (camera.isUsable()) {
      longest = longest == nullptr || camera.num_images > longest->num_images ? &camera : longest;
    }
  }
  const double keep_every = static_cast<double>(longest->num_images) / kEnoughImages;
  if (keep_every < 2.0 || !longest->timing.is_regular) {
    return "";
  }
  return format(" --bag-freq %.3g", 1.0 / ((std::round(keep_every) - 0.5) * longest->timing.period_s));
}

}  // namespace

std::string inspectionText(const Inspection& inspection) {
  std::string text = inspection.recording + '\n';
  for (const CameraInspection& camera : inspection.cameras) {
    text += cameraText(camera, inspection.target);
  }
  return text + synchronizationText(inspection) + otherText(inspection);
}

std::optional<double> neededTolerance_s(const Inspection& inspection) {
  constexpr double kDefault_s = 0.02;  // of calibrate_cameras
  constexpr double kSlack_s = 0.001;
  double needed_s = 0.0;
  for (const auto& [index, sync] : inspection.synchronizations) {
    needed_s = std::max(needed_s, std::min(sync.max_offset_s + kSlack_s, sync.half_period_s));
  }
  return needed_s > kDefault_s ? std::make_optional(needed_s) : std::nullopt;
}

std::string calibrationCommand(const Inspection& inspection, const std::string& target_file) {
  std::string topics;
  std::string models;
  for (const CameraInspection& camera : inspection.cameras) {
    if (camera.isUsable()) {
      topics += ' ' + quoted(camera.topic);
      models += " ds-none";
    }
  }
  if (topics.empty()) {
    return "";
  }
  const std::optional<double> tolerance_s = neededTolerance_s(inspection);
  return "rosrun tartan_calib calibrate_cameras --bag " + quoted(inspection.recording) + " --target " +
         (target_file.empty() ? "board.yaml" : quoted(target_file)) + " --topics" + topics + " --models" + models +
         (tolerance_s ? format(" --approx-sync %.3f", *tolerance_s) : "") + rateFlag(inspection);
}

}  // namespace tartan_calib::apps
