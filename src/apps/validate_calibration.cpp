#include "validate_calibration/validate_calibration.h"

#include <iostream>

#include "common/interrupt.h"
#include "common/program.h"

namespace {

using namespace tartan_calib::apps;

int run(const std::vector<std::string>& words) {
  if (words.empty()) {
    std::cout << validateHelp();
    return kWrongUsage;
  }
  const std::optional<ValidateOptions> options = parseValidateOptions(words);
  if (!options) {
    std::cout << validateHelp();
    return kSuccess;
  }
  validateCalibration(*options);
  return kSuccess;
}

}  // namespace

int main(int argc, char** argv) {
  installInterruptHandler();
  return runProgram(argc, argv, run);
}
