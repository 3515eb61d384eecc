#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tartan_calib/target/target.h"

namespace tartan_calib::apps {

struct CreateTargetOptions {
  target::Target target;
  std::string base = "target";  ///< of the files' names
  std::string page;             ///< see layOut
  std::optional<double> dpi;    ///< of the PNG, which is written only then
};

const char* createTargetHelp();

/// Empty where help is asked for. Throws UsageError for a command line that makes no sense, InputError for a target file
/// that cannot be used.
std::optional<CreateTargetOptions> parseCreateTargetOptions(const std::vector<std::string>& arguments);

/// What was written, for people, one line a file.
std::string createTarget(const CreateTargetOptions& options);

}  // namespace tartan_calib::apps
