#pragma once

#include "tartan_calib/pipeline/calibrate.h"
#include "tartan_calib/report/listener.h"

namespace tartan_calib::report {

inline bool isCancelled(const Listener& listener) { return listener.is_cancelled && listener.is_cancelled(); }

inline void throwIfCancelled(const Listener& listener) {
  if (isCancelled(listener)) {
    throw pipeline::Cancelled("the report was stopped");
  }
}

}  // namespace tartan_calib::report
