#include "detect_corners/detect_corners.h"

#include <iostream>

#include "common/interrupt.h"
#include "common/program.h"

namespace {

using namespace tartan_calib::apps;

int run(int argc, char** argv) {
  if (argc == 1) {
    std::cout << detectHelp();
    return kWrongUsage;
  }
  const std::optional<DetectOptions> options = parseDetectOptions(argc, argv);
  if (!options) {
    std::cout << detectHelp();
    return kSuccess;
  }
  detectCorners(*options);
  return kSuccess;
}

}  // namespace

int main(int argc, char** argv) {
  installInterruptHandler();
  return runProgram([&] { return run(argc, argv); });
}
