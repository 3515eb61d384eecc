#include "calibrate_cameras/inputs.h"

#include <algorithm>
#include <cstdlib>

#include "common/program.h"
#include "common/recording.h"
#include "tartan_calib/io/camchain.h"
#include "tartan_calib/io/corners_csv.h"
#include "tartan_calib/text.h"

namespace tartan_calib::apps {
namespace {

/// Takes over what the arguments leave to the camchain.
void applyInit(const std::string& path, Inputs& inputs) {
  const io::Camchain chain = io::loadCamchain(path);
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

void applyFocalHint(const char* value, Inputs& inputs, const Warn& warn) {
  inputs.options.focal_hint_px = focalHint(value);
  if (value != nullptr && !inputs.options.focal_hint_px) {
    warn("KALIBR_MANUAL_FOCAL_LENGTH_INIT is ignored: '" + std::string(value) +
         "' is no focal length in pixels above 10, and none is needed");
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
  if (!arguments.init_file.empty()) {
    applyInit(arguments.init_file, inputs);
  }
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
  }
  if (inputs.options.models.size() != inputs.topics.size()) {
    throw UsageError("exactly one camera model per topic is needed: there are " +
                     std::to_string(inputs.options.models.size()) + " models and " + std::to_string(inputs.topics.size()) +
                     " topics");
  }
  if (inputs.corners.empty()) {
    inputs.streams = openRecording(arguments.recording, inputs.topics, arguments.selection, warn);
    inputs.topics = topicsOf(inputs.streams);
  }
  return inputs;
}

pipeline::CalibrationResult calibrate(const Inputs& inputs, const pipeline::Listener& listener) {
  return inputs.corners.empty() ? pipeline::calibrate(inputs.streams, inputs.target, inputs.options, listener)
                                : pipeline::calibrateCorners(inputs.corners, inputs.target, inputs.options, listener);
}

}  // namespace tartan_calib::apps
