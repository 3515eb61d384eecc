#include "common/output.h"

#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>

#include "tartan_calib/error.h"

namespace tartan_calib::apps {

namespace fs = std::filesystem;

/// Folders such as `.` and `rig/` have no name of their own to begin a file's name with.
std::string recordingPrefix(const std::string& recording) {
  if (!fs::is_directory(recording)) {
    return fs::path(recording).replace_extension().string();
  }
  fs::path path = fs::path(recording).lexically_normal();
  if (path.filename().empty()) {
    path = path.parent_path();
  }
  const bool has_name = !path.filename().empty() && path.filename() != "." && path.filename() != "..";
  return (has_name ? path : fs::canonical(recording)).string();
}

void checkFolderOf(const std::string& path) {
  const fs::path parent = fs::path(path).parent_path();
  const std::string folder = parent.empty() ? "." : parent.string();
  if (access(folder.c_str(), W_OK) != 0) {
    throw InputError("cannot write " + path + ": folder " + folder + " cannot be written to (" + std::strerror(errno) + ")");
  }
}

}  // namespace tartan_calib::apps
