#include <cstdio>
#include <string>
#include <vector>

#include "calibrate_cameras/arguments.h"
#include "calibrate_cameras/console.h"
#include "calibrate_cameras/inputs.h"
#include "calibrate_cameras/outputs.h"
#include "common/interrupt.h"
#include "common/program.h"

namespace {

using namespace tartan_calib;

std::string commandText(const std::vector<std::string>& words) {
  std::string text = "calibrate_cameras";
  for (const std::string& word : words) {
    text += " " + word;
  }
  return text;
}

int run(const std::vector<std::string>& words) {
  const apps::Arguments arguments = words.empty() ? apps::Arguments{} : apps::parseArguments(words);
  if (words.empty() || arguments.help) {
    std::fputs(apps::helpText().c_str(), stdout);
    return words.empty() ? apps::kWrongUsage : apps::kSuccess;
  }
  apps::checkWritable(apps::outputPrefix(arguments));
  const apps::Inputs inputs = apps::openInputs(arguments, apps::printWarning);
  apps::Console console(inputs);
  const pipeline::CalibrationResult result = apps::calibrate(inputs, console.listener());
  console.printResult(result);
  if (arguments.verbose) {
    console.printTimes(result);
  }
  const apps::UninterruptedSection files_are_written_whole;
  console.printFiles(apps::writeOutputs(result, arguments, inputs.options, commandText(words)));
  return apps::kSuccess;
}

}  // namespace

int main(int argc, char** argv) {
  apps::installInterruptHandler();
  return apps::runProgram([&] { return run(std::vector<std::string>(argv + 1, argv + argc)); });
}
