#pragma once

#include <deque>
#include <string>
#include <string_view>

namespace tartan_calib::io {

/// A file that appears under its name only when it is complete: text goes to a temporary file in the same folder, which
/// commit() flushes to the disk and renames. Without commit nothing is left behind and an older file stays as it was.
/// Something that is no regular file (a pipe, /dev/stdout) is written directly. Failures, a full disk among them, throw
/// InputError with the path and the system's reason.
class AtomicFile {
 public:
  explicit AtomicFile(const std::string& path);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  void write(std::string_view text);

  /// Everything is on the disk and the file is closed; only its name is missing.
  void complete();
  void commit();

 private:
  void flush();
  void closeFile();

  std::string path_;            ///< as the caller named it
  std::string final_path_;      ///< links resolved
  std::string temporary_path_;  ///< empty where the file is written directly
  std::string buffer_;
  int descriptor_ = -1;
};

/// Files that belong together: none has its name before all are complete, so that a full disk leaves all of them as they
/// were.
class AtomicFileSet {
 public:
  /// The reference is valid while the set is.
  AtomicFile& add(const std::string& path) { return files_.emplace_back(path); }
  void commit();

 private:
  std::deque<AtomicFile> files_;
};

/// All of `text` as one AtomicFile.
void writeFile(const std::string& path, std::string_view text);

}  // namespace tartan_calib::io
