#pragma once

#include <string>
#include <vector>

#include "tartan_calib/report/analysis.h"

namespace tartan_calib::report {

enum class Grade { kGood, kUsable, kRepeat };

/// `good`, `usable`, `repeat`.
std::string gradeName(Grade grade);

struct Reason {
  Grade grade = Grade::kUsable;  ///< what this alone makes of the calibration
  std::string text;              ///< what is the matter, and what to do
  std::string warning = {};      ///< of the calibration, that says the same; empty where there is none
};

struct Verdict {
  Grade grade = Grade::kGood;      ///< the worst of the reasons'
  std::vector<std::string> facts;  ///< one line per camera: how far it reaches and how certain it is
  std::vector<Reason> reasons;     ///< worst first; empty where good
};

/// Whether to trust a calibration, and why not.
Verdict judge(const pipeline::CalibrationResult& result, const Analysis& analysis);

}  // namespace tartan_calib::report
