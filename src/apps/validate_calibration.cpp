#include "validate_calibration/validate_calibration.h"

#include <iostream>

#include "common/interrupt.h"
#include "common/program.h"

namespace {

using namespace tartan_calib::apps;

int run(int argc, char** argv) {
  if (argc == 1) {
    std::cout << validateHelp();
    return kWrongUsage;
  }
  const std::optional<ValidateOptions> options = parseValidateOptions(argc, argv);
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
  return runProgram([&] { return run(argc, argv); });
}
