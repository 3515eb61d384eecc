#pragma once

#include <diagnostic_msgs/DiagnosticStatus.h>

#include <string>
#include <utility>

#include "live/image_input.h"

namespace tartan_calib::apps {

/// Whether images of a camera arrive, can be read and are kept up with.
class CameraMonitor {
 public:
  CameraMonitor(int camera_index, std::string topic) : camera_index_(camera_index), topic_(std::move(topic)) {}

  void countProcessed() { ++now_.processed; }
  void countUnreadable(const std::string& reason);

  /// About what happened since the last call, that long ago: STALE without images, ERROR where one could not be read; values
  /// for rate, received, dropped, unreadable.
  diagnostic_msgs::DiagnosticStatus status(const InputCounts& counts, double interval_s);

 private:
  struct Counts {
    std::size_t processed = 0;
    std::size_t unreadable = 0;
    std::size_t received = 0;
  };

  int camera_index_;
  std::string topic_;
  Counts now_;
  Counts before_;
  std::string unreadable_reason_;
};

}  // namespace tartan_calib::apps
