#pragma once

#include <cstddef>
#include <functional>

namespace tartan_calib::report {

/// Told while a part of the report is made. Any member may stay empty.
struct Listener {
  /// Called by one thread at a time, not always by the one that called. `total` is 0 where it is not known.
  std::function<void(std::size_t done, std::size_t total)> progress;
  std::function<bool()> is_cancelled;  ///< asked several times a second; what was asked for ends with pipeline::Cancelled
};

}  // namespace tartan_calib::report
