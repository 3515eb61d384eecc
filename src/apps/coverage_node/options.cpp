#include "coverage_node/options.h"

#include <limits>

#include "calibrate_cameras/outputs.h"
#include "calibrate_cameras/session.h"
#include "common/output.h"
#include "common/program.h"
#include "tartan_calib/io/camchain.h"

namespace tartan_calib::apps {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kBytesPerMegabyte = 1048576.0;

using Words = std::vector<std::string>;

/// What the bag calls a topic: it holds the images as sensor_msgs/Image.
std::string recordedTopic(const std::string& topic) {
  const std::string suffix = "/compressed";
  const bool has_suffix =
      topic.size() > suffix.size() && topic.compare(topic.size() - suffix.size(), suffix.size(), suffix) == 0;
  return has_suffix ? topic.substr(0, topic.size() - suffix.size()) : topic;
}

void append(Words& words, const std::string& flag, const Words& values) {
  words.push_back(flag);
  words.insert(words.end(), values.begin(), values.end());
}

/// Views take minutes to collect: a folder that cannot hold them is found out before the first one.
void checkOutput(const std::string& recording) {
  try {
    checkFolderOf(recording);
  } catch (const InputError& error) {
    throw InputError(std::string("parameter ~output: ") + error.what());
  }
}

guidance::GuideOptions guideOptions(Parameters& parameters, const pipeline::CalibrateOptions& calibrate) {
  guidance::GuideOptions guide;
  guide.calibrate = calibrate;
  guide.max_views = static_cast<std::size_t>(parameters.number("max_views", static_cast<double>(guide.max_views),
                                                               static_cast<double>(guide.first_solve_views), 1e6));
  guide.max_bytes = static_cast<std::size_t>(
      kBytesPerMegabyte *
      parameters.number("max_memory_mb", static_cast<double>(guide.max_bytes) / kBytesPerMegabyte, 1.0, 1e6));
  guide.max_blur_px = parameters.number("max_blur_px", guide.max_blur_px, 0.0, kInfinity);
  guide.min_gain_bits = parameters.number("min_gain_bits", guide.min_gain_bits, 0.0, kInfinity);
  return guide;
}

}  // namespace

CoverageOptions coverageOptions(Parameters parameters, const ::ros::NodeHandle& node) {
  constexpr double kMinWidth_px = 160.0;
  constexpr double kMaxWidth_px = 8192.0;
  CoverageOptions options;
  Words recorded;
  for (const std::string& topic : parameters.words("topics")) {
    options.topics.push_back(node.resolveName(topic));
    recorded.push_back(recordedTopic(options.topics.back()));
  }
  Words words = {"--target", parameters.text("target"), "--bag", parameters.text("output", "live") + ".bag"};
  append(words, "--topics", recorded);
  append(words, "--models", parameters.words("models"));
  const Words extra = parameters.words("options", {});
  words.insert(words.end(), extra.begin(), extra.end());
  options.calibration = parseArguments(words);
  checkInputsStay(options.calibration);
  checkOutput(options.calibration.recording);
  options.command = commandText("calibrate_cameras", words);
  for (const std::string& model : options.calibration.calibrate.models) {
    camera::modelByName(model);
  }

  options.guide = guideOptions(parameters, options.calibration.calibrate);
  if (!options.calibration.init_file.empty()) {
    options.guide.calibrate.known_rig = io::loadCamchain(options.calibration.init_file).rig;
  }
  options.input.sync_ns = options.calibration.calibrate.approx_sync_ns;
  options.input.max_rate_hz = parameters.number("max_rate", options.input.max_rate_hz, 0.0, kInfinity);
  options.overlay_width_px =
      static_cast<int>(parameters.number("overlay_width", options.overlay_width_px, kMinWidth_px, kMaxWidth_px));
  parameters.checkAllKnown();
  return options;
}

}  // namespace tartan_calib::apps
