#include "detect_corners/detect_corners.h"

#include <iostream>

#include "common/interrupt.h"
#include "common/program.h"

namespace {

using namespace tartan_calib::apps;

int run(const std::vector<std::string>& words) {
  if (words.empty()) {
    std::cout << detectHelp();
    return kWrongUsage;
  }
  const std::optional<DetectOptions> options = parseDetectOptions(words);
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
  return runProgram(argc, argv, run);
}
