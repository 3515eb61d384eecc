#pragma once

#include <string>
#include <vector>

#include "tartan_calib/report/analysis.h"
#include "tartan_calib/report/pictures.h"
#include "tartan_calib/report/verdict.h"

namespace tartan_calib::report {

/// Everything that the pages show.
struct ReportData {
  std::string recording;
  const pipeline::CalibrationResult& result;
  const Analysis& analysis;
  const Verdict& verdict;
  const std::vector<CameraPictures>& pictures;
};

/// Writes data.json and, as it names them, tables of doubles (row by row, the machine's byte order) into a folder, which
/// holds the pictures already: what scripts/report draws from.
void writeReportData(const std::string& folder, const ReportData& data);

}  // namespace tartan_calib::report
