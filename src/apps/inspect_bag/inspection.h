#pragma once

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/progress_bar.h"
#include "inspect_bag/image_quality.h"
#include "inspect_bag/timing.h"
#include "tartan_calib/pipeline/calibrate.h"
#include "tartan_calib/ros/bag_contents.h"
#include "tartan_calib/target/target.h"

namespace tartan_calib::apps {

/// Images of a topic that are decoded, evenly in time: a recording's length does not matter.
constexpr std::size_t kMaxSamples = 40;

using ImageSize = std::pair<int, int>;  ///< width, height

/// What is known of one camera.
struct CameraInspection {
  std::string topic;
  std::string type;
  std::vector<std::string> encodings;      ///< that occur
  std::map<ImageSize, std::size_t> sizes;  ///< of all images; of the sampled ones where messages do not say it
  std::size_t num_images = 0;
  std::size_t num_unreadable = 0;  ///< messages, and samples that cannot be decoded
  std::string unreadable_reason;   ///< of the first such sample
  std::string refusal;             ///< why a calibration refuses the topic for its unreadable messages; empty otherwise
  bool is_supported = true;
  TopicTiming timing;
  std::vector<ImageQuality> samples;
  pipeline::CameraCorners corners;  ///< of the samples; empty without a target
  std::string left_out;             ///< why it does not belong into a calibration; empty where it does

  bool isUsable() const { return left_out.empty(); }
};

struct Inspection {
  std::string recording;
  std::optional<target::Target> target;
  std::vector<CameraInspection> cameras;  ///< topics with images
  /// Of every usable camera against the first usable one, whose own is left out.
  std::vector<std::pair<std::size_t, Synchronization>> synchronizations;
  std::vector<ros::OtherTopic> other_topics;
};

/// A bag, or a folder in kalibr_bagcreater's layout. `progress` is told of the images that are decoded. Throws InputError
/// where it cannot be read or has no images.
Inspection inspect(const std::string& recording, const std::optional<target::Target>& target,
                   const ProgressCall& progress = {});

/// `width x height` of most images; zeros where nothing is known.
ImageSize usualSize(const CameraInspection& camera);

}  // namespace tartan_calib::apps
