#include "create_target/create_target.h"

#include <iostream>

#include "common/interrupt.h"
#include "common/program.h"

namespace {

using namespace tartan_calib::apps;

int run(int argc, char** argv) {
  const auto options = parseCreateTargetOptions({argv + 1, argv + argc});
  if (argc == 1 || !options) {
    std::cout << createTargetHelp();
    return argc == 1 ? kWrongUsage : kSuccess;
  }
  installInterruptHandler();
  std::cout << createTarget(*options);
  return kSuccess;
}

}  // namespace

int main(int argc, char** argv) {
  return runProgram([&] { return run(argc, argv); });
}
