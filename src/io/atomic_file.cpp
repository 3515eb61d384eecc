#include "tartan_calib/io/atomic_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <system_error>

#include "tartan_calib/error.h"

namespace tartan_calib::io {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kBufferBytes = 1 << 16;
constexpr mode_t kFileMode = 0666;  ///< before the user's umask

[[noreturn]] void fail(const std::string& path, int error_number) {
  throw InputError("cannot write " + path + ": " + std::generic_category().message(error_number));
}

/// A name in the folder of `path` that no other writer uses.
std::string temporaryBeside(const std::string& path) {
  static std::atomic<int> counter{0};
  const std::string name = ".tartan_calib-" + std::to_string(getpid()) + "-" + std::to_string(counter++) + ".tmp";
  return (fs::path(path).parent_path() / name).string();
}

/// Makes the new name itself survive a crash. Some file systems cannot do that for folders; the data are safe all the same.
void flushFolder(const std::string& path) {
  const fs::path folder = fs::path(path).parent_path();
  const int descriptor = open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor >= 0) {
    fsync(descriptor);
    close(descriptor);
  }
}

}  // namespace

AtomicFile::AtomicFile(const std::string& path) : path_(path), final_path_(path) {
  std::error_code error;
  if (fs::exists(path, error)) {
    final_path_ = fs::canonical(path, error).string();
    if (fs::is_directory(final_path_, error)) {
      fail(path_, EISDIR);
    }
  }
  if (fs::exists(final_path_, error) && !fs::is_regular_file(final_path_, error)) {
    descriptor_ = open(final_path_.c_str(), O_WRONLY | O_CLOEXEC);
  } else {
    temporary_path_ = temporaryBeside(final_path_);
    descriptor_ = open(temporary_path_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, kFileMode);
  }
  if (descriptor_ < 0) {
    temporary_path_.clear();
    fail(path_, errno);
  }
}

AtomicFile::~AtomicFile() {
  if (descriptor_ >= 0) {
    close(descriptor_);
  }
  if (!temporary_path_.empty()) {
    unlink(temporary_path_.c_str());
  }
}

void AtomicFile::write(std::string_view text) {
  buffer_ += text;
  if (buffer_.size() >= kBufferBytes) {
    flush();
  }
}

void AtomicFile::flush() {
  std::size_t done = 0;
  while (done < buffer_.size()) {
    const ssize_t written = ::write(descriptor_, buffer_.data() + done, buffer_.size() - done);
    if (written < 0 && errno != EINTR) {
      fail(path_, errno);
    }
    done += written > 0 ? static_cast<std::size_t>(written) : 0;
  }
  buffer_.clear();
}

void AtomicFile::closeFile() {
  const int descriptor = descriptor_;
  descriptor_ = -1;
  if (close(descriptor) != 0 && errno != EINTR) {
    fail(path_, errno);
  }
}

void AtomicFile::complete() {
  if (descriptor_ < 0) {
    return;
  }
  flush();
  if (!temporary_path_.empty() && fsync(descriptor_) != 0) {
    fail(path_, errno);
  }
  closeFile();
}

void AtomicFile::commit() {
  complete();
  if (temporary_path_.empty()) {
    return;
  }
  if (std::rename(temporary_path_.c_str(), final_path_.c_str()) != 0) {
    fail(path_, errno);
  }
  temporary_path_.clear();
  flushFolder(final_path_);
}

void AtomicFileSet::commit() {
  for (AtomicFile& file : files_) {
    file.complete();
  }
  for (AtomicFile& file : files_) {
    file.commit();
  }
}

void writeFile(const std::string& path, std::string_view text) {
  AtomicFile file(path);
  file.write(text);
  file.commit();
}

}  // namespace tartan_calib::io
