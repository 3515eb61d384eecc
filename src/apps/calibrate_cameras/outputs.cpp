#include "calibrate_cameras/outputs.h"

#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>

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

OutputFiles writeOutputs(const pipeline::CalibrationResult& result, const Arguments& arguments,
                         const pipeline::CalibrateOptions& options, const std::string& command) {
  const std::string prefix = outputPrefix(arguments);
  const std::string& recording = arguments.corners_file.empty() ? arguments.recording : arguments.corners_file;
  io::AtomicFileSet together;
  const auto add = [&](std::string& path, const char* suffix) -> io::AtomicFile& {
    path = prefix + suffix;
    return together.add(path);
  };
  OutputFiles files;
  add(files.camchain, "-camchain.yaml").write(io::camchainText(io::camchain(result)));
  add(files.results, "-results-cam.txt").write(io::resultsText(result));
  add(files.calibration, "-calibration.yaml")
      .write(io::calibrationText(result, options, {recording, arguments.target_file, command}));
  if (arguments.export_poses) {
    add(files.poses, "-poses-cam0.csv").write(io::posesText(result));
  }
  if (arguments.export_corners) {
    io::writeCorners(pipeline::observedCorners(result), add(files.corners, kCornersSuffix));
  }
  together.commit();
  return files;
}

}  // namespace tartan_calib::apps
