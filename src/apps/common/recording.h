#pragma once

#include <boost/program_options.hpp>
#include <functional>
#include <string>
#include <vector>

#include "tartan_calib/io/recording.h"
#include "tartan_calib/pipeline/camera_stream.h"
#include "tartan_calib/target/target.h"

namespace tartan_calib::apps {

using Warn = std::function<void(const std::string&)>;

/// `--bag-from-to A B` and `--bag-freq HZ`, which say what images of a recording are wanted.
boost::program_options::options_description selectionOptions();

/// Their values. Throws UsageError.
io::RecordingOptions selectionFrom(const boost::program_options::variables_map& values);

/// The topics of a bag or of a folder with images, one stream each. `warn` is told what a user should know of. Throws
/// InputError.
std::vector<pipeline::CameraStream> openRecording(const std::string& path, const std::vector<std::string>& topics,
                                                  io::RecordingOptions selection, const Warn& warn);

/// Throws InputError where there is no such recording, so that nothing else is blamed for it.
void checkIsThere(const std::string& recording);

/// The board of a YAML file. Throws InputError.
target::Target openTarget(const std::string& path, const Warn& warn);

}  // namespace tartan_calib::apps
