#pragma once

#include <functional>
#include <optional>
#include <string>

#include "calibrate_cameras/inputs.h"
#include "tartan_calib/report/verdict.h"

namespace tartan_calib::apps {

/// The report of one run. The files are empty, and `failure` says why, where it could not be drawn.
struct ReportFiles {
  std::optional<report::Verdict> verdict;
  std::string pdf;
  std::string html;
  std::string failure;
};

/// Told while a report is made. `progress` may stay empty.
struct ReportListener {
  /// `total` is 0 where it is not known. Called by one thread at a time.
  std::function<void(const std::string& step, std::size_t done, std::size_t total)> progress;
  std::function<bool()> is_cancelled;
};

/// Judges the result and draws `<prefix>-report-cam.pdf` and `.html`. Where the listener cancels, nothing of the report is
/// left.
ReportFiles writeReport(const pipeline::CalibrationResult& result, const Inputs& inputs, const std::string& prefix,
                        const ReportListener& listener);

/// Opens the HTML page with xdg-open where standard output is a terminal and there is a display.
void showReport(const ReportFiles& files);

}  // namespace tartan_calib::apps
