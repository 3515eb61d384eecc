#pragma once

#include <atomic>
#include <cstddef>
#include <functional>
#include <string>
#include <thread>
#include <vector>

#include "calibrate_cameras/arguments.h"
#include "tartan_calib/guidance/kept_views.h"

namespace tartan_calib::apps {

/// Called on the thread of the job.
struct JobListener {
  std::function<void(const std::string& line)> progress;
  std::function<void(const std::string& yaml)> camchain;
};

/// Writes views to a bag and does with it what `calibrate_cameras` does, on a thread of its own.
class CalibrationJob {
 public:
  /// `arguments`, `command`: of calibrate_cameras, with the bag to write as recording.
  CalibrationJob(Arguments arguments, std::string command, JobListener listener);
  ~CalibrationJob();  ///< waits
  CalibrationJob(const CalibrationJob&) = delete;
  CalibrationJob& operator=(const CalibrationJob&) = delete;

  /// False, and nothing happens, while the last one runs.
  bool start(std::vector<guidance::KeptView> views);

  /// Until nothing runs. Once the node ends that is soon: the calibration stops.
  void wait();

  /// Views in the bag that was written last.
  std::size_t numWritten() const { return num_written_; }

 private:
  void run(const std::vector<guidance::KeptView>& views);

  Arguments arguments_;
  std::string command_;
  JobListener listener_;
  std::string finished_;  ///< what there is of the files, where it is stopped
  std::atomic<bool> is_running_{false};
  std::atomic<std::size_t> num_written_{0};
  std::thread thread_;
};

}  // namespace tartan_calib::apps
