#include "calibrate_cameras/inputs.h"

#include <algorithm>
#include <cstdlib>
#include <variant>

#include "common/program.h"
#include "common/recording.h"
#include "tartan_calib/io/camchain.h"
#include "tartan_calib/io/corners_csv.h"
#include "tartan_calib/text.h"

namespace tartan_calib::apps {
namespace {

/// Takes over what the arguments leave to the camchain.
void applyInit(const io::Camchain& chain, Inputs& inputs) {
  inputs.options.known_rig = chain.rig;
  if (inputs.options.models.empty()) {
    for (const calibration::RigCamera& camera : chain.rig.cameras) {
      inputs.options.models.push_back(camera::modelName(camera.camera.model));
    }
  }
  const bool has_topics =
      std::none_of(chain.topics.begin(), chain.topics.end(), [](const std::string& topic) { return topic.empty(); });
  if (inputs.topics.empty() && has_topics) {
    inputs.topics = chain.topics;
  }
}

template <class WithTopic>
std::vector<std::string> topicsOf(const std::vector<WithTopic>& cameras) {
  std::vector<std::string> topics;
  topics.reserve(cameras.size());
  for (const WithTopic& camera : cameras) {
    topics.push_back(camera.topic);
  }
  return topics;
}

void checkDistinct(const std::vector<std::string>& topics) {
  for (auto topic = topics.begin(); topic != topics.end(); ++topic) {
    if (std::find(topics.begin(), topic, *topic) != topic) {
      throw UsageError("topic " + *topic + " is there twice: every camera has a topic of its own");
    }
  }
}

/// Two cameras of one model and size in the wrong order would otherwise start as each other.
void noteOtherTopics(const Inputs& inputs, const io::Camchain& chain, const Warn& warn) {
  for (std::size_t i = 0; i < std::min(chain.topics.size(), inputs.topics.size()); ++i) {
    if (!chain.topics[i].empty() && chain.topics[i] != inputs.topics[i]) {
      warn(cameraName(i) + " is " + inputs.topics[i] + ", but " + chain.topics[i] +
           " in the calibration to start from: is the order of --topics that of --init?");
    }
  }
}

void checkCounts(const Arguments& arguments, const Inputs& inputs) {
  const std::size_t num_models = inputs.options.models.size();
  if (num_models != inputs.topics.size()) {
    const std::string source = arguments.calibrate.models.empty() ? " (those of --init)" : "";
    throw UsageError("exactly one camera model per topic is needed: there are " + std::to_string(num_models) + " models" +
                     source + " and " + std::to_string(inputs.topics.size()) + " topics");
  }
}

InputError noSuchTopic(const std::string& path, const std::string& topic, const std::vector<pipeline::CameraCorners>& all) {
  return InputError("corners file " + path + " has no topic " + topic + "; its topics: " + joined(topicsOf(all)));
}

/// The cameras of a corners file that the topics name, in their order; all where no topic is given.
std::vector<pipeline::CameraCorners> openCorners(const std::string& path, const std::vector<std::string>& topics) {
  const std::vector<pipeline::CameraCorners> all = io::loadCorners(path);
  std::vector<pipeline::CameraCorners> cameras = topics.empty() ? all : std::vector<pipeline::CameraCorners>{};
  for (const std::string& topic : topics) {
    const auto found = std::find_if(all.begin(), all.end(), [&](const auto& camera) { return camera.topic == topic; });
    if (found == all.end()) {
      throw noSuchTopic(path, topic, all);
    }
    cameras.push_back(*found);
  }
  return cameras;
}

/// Circles are found at their centres; all kinds of refinement are for the corners of tags and squares.
void noteRefinement(const Inputs& inputs, const Warn& warn) {
  const bool is_circles = std::holds_alternative<target::CircleGrid>(inputs.target);
  if (is_circles && inputs.options.recovery.refinement != detection::RecoveryOptions().refinement) {
    warn("--refinement has no effect: circles are not refined");
  }
}

void applyFocalHint(const char* value, Inputs& inputs, const Warn& warn) {
  inputs.options.focal_hint_px = focalHint(value);
  if (value != nullptr && !inputs.options.focal_hint_px) {
    warn("KALIBR_MANUAL_FOCAL_LENGTH_INIT is ignored: '" + std::string(value) +
         "' is no focal length of more than 10 and less than 1000000 pixels, and none is needed");
  }
}

}  // namespace

Inputs openInputs(const Arguments& arguments, const Warn& warn) {
  Inputs inputs;
  inputs.options = arguments.calibrate;
  inputs.topics = arguments.topics;
  for (const std::string& model : inputs.options.models) {
    camera::modelByName(model);
  }
  inputs.target = openTarget(arguments.target_file, warn);
  applyFocalHint(std::getenv("KALIBR_MANUAL_FOCAL_LENGTH_INIT"), inputs, warn);
  io::Camchain start;
  if (!arguments.init_file.empty()) {
    start = io::loadCamchain(arguments.init_file);
    applyInit(start, inputs);
  }
  checkDistinct(inputs.topics);
  if (!arguments.corners_file.empty() && !arguments.recording.empty()) {
    warn("the images of " + arguments.recording +
         " are not read, as --corners takes their place; the results are named after the recording");
  }
  if (!arguments.corners_file.empty()) {
    inputs.dataset = arguments.corners_file;
    inputs.corners = openCorners(arguments.corners_file, inputs.topics);
    inputs.topics = topicsOf(inputs.corners);
  } else {
    if (inputs.topics.empty()) {
      throw UsageError("--topics is missing: " + arguments.init_file + " names none");
    }
    inputs.dataset = arguments.recording;
    noteRefinement(inputs, warn);
  }
  checkCounts(arguments, inputs);
  if (inputs.corners.empty()) {
    inputs.streams = openRecording(arguments.recording, inputs.topics, arguments.selection, warn);
    inputs.topics = topicsOf(inputs.streams);
  }
  checkDistinct(inputs.topics);  // a folder's topic has several names
  noteOtherTopics(inputs, start, warn);
  return inputs;
}

pipeline::CalibrationResult calibrate(const Inputs& inputs, const pipeline::Listener& listener) {
  return inputs.corners.empty() ? pipeline::calibrate(inputs.streams, inputs.target, inputs.options, listener)
                                : pipeline::calibrateCorners(inputs.corners, inputs.target, inputs.options, listener);
}

}  // namespace tartan_calib::apps
