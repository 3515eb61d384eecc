#pragma once

#include <functional>
#include <string>

namespace tartan_calib::report {

/// Runs the Python script that draws report.pdf and report.html from the data in `folder`, and moves them to `pdf_path` and
/// `html_path`, each whole or not at all. Throws InputError that says why there is no report: no Python, no matplotlib, ...
/// Where `is_cancelled` says so, the script is ended, nothing moved, and pipeline::Cancelled thrown.
void drawReport(const std::string& script, const std::string& folder, const std::string& pdf_path,
                const std::string& html_path, const std::function<bool()>& is_cancelled);

}  // namespace tartan_calib::report
