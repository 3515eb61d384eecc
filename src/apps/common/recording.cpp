#include "common/recording.h"

#include <filesystem>

#include "common/program.h"
#include "tartan_calib/io/image_folder.h"
#include "tartan_calib/io/target_yaml.h"
#include "tartan_calib/ros/bag_reader.h"

namespace tartan_calib::apps {

namespace po = boost::program_options;

po::options_description selectionOptions() {
  po::options_description options;
  options.add_options()("bag-from-to", po::value<std::vector<double>>()->multitoken(), "");
  options.add_options()("bag-freq", po::value<double>(), "");
  return options;
}

io::RecordingOptions selectionFrom(const po::variables_map& values) {
  io::RecordingOptions selection;
  if (values.count("bag-from-to") > 0) {
    const auto& window = values["bag-from-to"].as<std::vector<double>>();
    if (window.size() != 2) {
      throw UsageError("--bag-from-to needs two numbers of seconds: the start and the end");
    }
    selection.window = io::TimeWindow{window[0], window[1]};
  }
  if (values.count("bag-freq") > 0) {
    selection.max_rate_hz = values["bag-freq"].as<double>();
  }
  return selection;
}

std::vector<pipeline::CameraStream> openRecording(const std::string& path, const std::vector<std::string>& topics,
                                                  io::RecordingOptions selection, const Warn& warn) {
  selection.notice = warn;
  return std::filesystem::is_directory(path) ? io::openImageFolder(path, topics, selection)
                                             : ros::openBag(path, topics, selection);
}

void checkIsThere(const std::string& recording) {
  if (!std::filesystem::exists(recording)) {
    throw InputError("bag " + recording + " does not exist: check the path");
  }
}

target::Target openTarget(const std::string& path, const Warn& warn) {
  const io::LoadedTarget loaded = io::loadTarget(path);
  for (const std::string& warning : loaded.warnings) {
    warn(warning);
  }
  return loaded.target;
}

}  // namespace tartan_calib::apps
