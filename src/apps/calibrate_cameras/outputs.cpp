#include "calibrate_cameras/outputs.h"

#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <system_error>
#include <utility>

#include "common/output.h"
#include "tartan_calib/error.h"
#include "tartan_calib/io/atomic_file.h"
#include "tartan_calib/io/calibration_yaml.h"
#include "tartan_calib/io/camchain.h"
#include "tartan_calib/io/corners_csv.h"
#include "tartan_calib/io/poses_csv.h"
#include "tartan_calib/io/results_text.h"

namespace tartan_calib::apps {
namespace {

namespace fs = std::filesystem;

constexpr const char* kCornersSuffix = "-corners.csv";

bool endsWith(const std::string& text, const std::string& end) {
  return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

}  // namespace

std::string outputPrefix(const Arguments& arguments) {
  if (!arguments.output_prefix.empty()) {
    return arguments.output_prefix;
  }
  if (!arguments.recording.empty()) {
    return recordingPrefix(arguments.recording);
  }
  const std::string& corners = arguments.corners_file;
  return endsWith(corners, kCornersSuffix) ? corners.substr(0, corners.size() - std::strlen(kCornersSuffix))
                                           : fs::path(corners).replace_extension().string();
}

void checkWritable(const std::string& prefix) {
  const fs::path parent = fs::path(prefix).parent_path();
  const std::string folder = parent.empty() ? "." : parent.string();
  if (access(folder.c_str(), W_OK) != 0) {
    throw InputError("results are written beside the recording, but folder " + folder + " cannot be written to (" +
                     std::strerror(errno) + "): make a link to the recording in another folder and give that to --bag");
  }
}

OutputFiles outputFiles(const Arguments& arguments) {
  const std::string prefix = outputPrefix(arguments);
  OutputFiles files;
  files.camchain = prefix + "-camchain.yaml";
  files.results = prefix + "-results-cam.txt";
  files.calibration = prefix + "-calibration.yaml";
  files.poses = arguments.export_poses ? prefix + "-poses-cam0.csv" : "";
  files.corners = arguments.export_corners ? prefix + kCornersSuffix : "";
  return files;
}

void checkInputsStay(const Arguments& arguments, const std::vector<std::string>& more_outputs) {
  const OutputFiles files = outputFiles(arguments);
  std::vector<std::string> outputs = {files.camchain, files.results, files.calibration, files.poses, files.corners};
  outputs.insert(outputs.end(), more_outputs.begin(), more_outputs.end());
  const std::array<std::pair<const char*, std::string>, 3> inputs = {
      {{"--init", arguments.init_file}, {"--corners", arguments.corners_file}, {"--target", arguments.target_file}}};
  for (const auto& [flag, input] : inputs) {
    for (const std::string& output : outputs) {
      std::error_code is_missing;  // two files that are not there are not the same
      if (!input.empty() && fs::equivalent(input, output, is_missing)) {
        throw InputError("the result would be written over " + input + ", which " + flag +
                         " reads: rename or copy that file, and give the new name");
      }
    }
  }
}

OutputFiles writeOutputs(const pipeline::CalibrationResult& result, const Arguments& arguments,
                         const pipeline::CalibrateOptions& options, const std::string& command) {
  const std::string& recording = arguments.corners_file.empty() ? arguments.recording : arguments.corners_file;
  io::AtomicFileSet together;
  OutputFiles files = outputFiles(arguments);
  together.add(files.camchain).write(io::camchainText(io::camchain(result)));
  together.add(files.results).write(io::resultsText(result));
  together.add(files.calibration).write(io::calibrationText(result, options, {recording, arguments.target_file, command}));
  if (!files.poses.empty()) {
    together.add(files.poses).write(io::posesText(result));
  }
  if (!files.corners.empty()) {
    io::writeCorners(pipeline::observedCorners(result), together.add(files.corners));
  }
  together.commit();
  return files;
}

}  // namespace tartan_calib::apps
