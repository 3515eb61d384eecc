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

/// Judges the result and draws `<prefix>-report-cam.pdf` and `.html`. Once `is_cancelled` says so it stops, and nothing of
/// the report is left. `on_drawing` is called now and then while the pages are drawn.
ReportFiles writeReport(const pipeline::CalibrationResult& result, const Inputs& inputs, const std::string& prefix,
                        const std::function<bool()>& is_cancelled, const std::function<void()>& on_drawing = nullptr);

/// Opens the HTML page with xdg-open where standard output is a terminal and there is a display.
void showReport(const ReportFiles& files);

}  // namespace tartan_calib::apps
