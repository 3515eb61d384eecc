#include <cstdio>
#include <string>
#include <vector>

#include "calibrate_cameras/arguments.h"
#include "calibrate_cameras/session.h"
#include "common/interrupt.h"
#include "common/program.h"

namespace {

using namespace tartan_calib;

int run(const std::vector<std::string>& words) {
  const apps::Arguments arguments = words.empty() ? apps::Arguments{} : apps::parseArguments(words);
  if (words.empty() || arguments.help) {
    std::fputs(apps::helpText().c_str(), stdout);
    return words.empty() ? apps::kWrongUsage : apps::kSuccess;
  }
  apps::runSession(arguments, apps::commandText("calibrate_cameras", words));
  return apps::kSuccess;
}

}  // namespace

int main(int argc, char** argv) {
  apps::installInterruptHandler();
  return apps::runProgram(argc, argv, run);
}
