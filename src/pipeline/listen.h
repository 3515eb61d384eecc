#pragma once

#include <string>

#include "tartan_calib/pipeline/calibrate.h"

namespace tartan_calib::pipeline {

/// Tell a listener whose members may be empty.
inline void report(const Listener& listener, const Progress& progress) {
  if (listener.progress) {
    listener.progress(progress);
  }
}

inline bool isCancelled(const Listener& listener) { return listener.is_cancelled && listener.is_cancelled(); }

inline void throwIfCancelled(const Listener& listener) {
  if (isCancelled(listener)) {
    throw Cancelled("the calibration was stopped");
  }
}

}  // namespace tartan_calib::pipeline
