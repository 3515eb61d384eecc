#include "create_target/create_target.h"

#include <iostream>

#include "common/interrupt.h"
#include "common/program.h"

namespace {

using namespace tartan_calib::apps;

int run(const std::vector<std::string>& words) {
  const auto options = parseCreateTargetOptions(words);
  if (words.empty() || !options) {
    std::cout << createTargetHelp();
    return words.empty() ? kWrongUsage : kSuccess;
  }
  installInterruptHandler();
  std::cout << createTarget(*options);
  return kSuccess;
}

}  // namespace

int main(int argc, char** argv) { return runProgram(argc, argv, run); }
