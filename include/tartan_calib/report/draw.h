#pragma once

#include <string>

#include "tartan_calib/report/listener.h"

namespace tartan_calib::report {

/// Runs the Python script that draws report.pdf and report.html from the data in `folder`, and moves them to `pdf_path` and
/// `html_path`, each whole or not at all. Throws InputError that says why there is no report: no Python, no matplotlib, ...
/// The listener is told of the parts that the script counts in the file `drawn`: their number in the first line, and a dot
/// for each that is done. Where it cancels, the script is ended and nothing moved.
void drawReport(const std::string& script, const std::string& folder, const std::string& pdf_path,
                const std::string& html_path, const Listener& listener = {});

}  // namespace tartan_calib::report
