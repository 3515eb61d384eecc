#include <unistd.h>

#include <iostream>

#include "common/command_line.h"
#include "common/interrupt.h"
#include "common/program.h"
#include "common/progress_bar.h"
#include "common/recording.h"
#include "inspect_bag/report.h"

namespace {

namespace po = boost::program_options;
using namespace tartan_calib;
using namespace tartan_calib::apps;

constexpr const char* kHelp =
    R"(Says what is in a recording, what would spoil its calibration, and with which command to calibrate.

  rosrun tartan_calib inspect_bag rig.bag --target april_6x6.yaml

lists rate, gaps, stamps, light and sharpness of every camera, how well cameras are synchronised, and whether the board is
seen and where. It reads the bag's index and at most 40 images of each topic, so that it takes seconds for a bag of any size.

  bag               ROS bag, or folder with a subfolder of images per camera; --bag is understood too
  --target T.yaml   look for this board
  -h, --help        this text
)";

po::variables_map parse(const std::vector<std::string>& words) {
  po::options_description options;
  options.add_options()("help,h", "")("bag", po::value<std::string>())("target", po::value<std::string>());
  po::positional_options_description bag;
  bag.add("bag", 1);
  return parseCommandLine(words, options, bag);
}

void print(const Inspection& inspection, const std::string& target_file) {
  std::cout << inspectionText(inspection) << '\n';
  const std::vector<std::string> warnings = inspectionWarnings(inspection);
  for (const std::string& warning : warnings) {
    printWarning(warning);
  }
  if (warnings.empty()) {
    std::cout << "Nothing speaks against a calibration"
              << (inspection.target ? ".\n" : " (the board was not looked for: give --target).\n");
  }
  const std::string command = calibrationCommand(inspection, target_file);
  if (!command.empty()) {
    std::cout << "\nTo calibrate (ds-none takes any lens; pinhole-radtan is usual below 90 degrees):\n  " << command << '\n';
  }
}

int run(const std::vector<std::string>& words) {
  const po::variables_map values = parse(words);
  if (const std::optional<int> exit_code = answerHelp(words, values, kHelp)) {
    return *exit_code;
  }
  if (values.count("bag") == 0) {
    throw UsageError("a bag is needed; see --help");
  }
  const std::string target_file = values.count("target") > 0 ? values["target"].as<std::string>() : "";
  std::optional<target::Target> target;
  if (!target_file.empty()) {
    target = openTarget(target_file, printWarning);
  }
  installInterruptHandler();
  ProgressBar bar(isatty(STDOUT_FILENO) != 0);
  const Inspection inspection =
      inspect(values["bag"].as<std::string>(), target, [&bar](std::size_t done, std::size_t total) {
        bar.show(done, total);
        setItemsDone(done, total, "images");
      });
  bar.clear();
  print(inspection, target_file);
  return kSuccess;
}

}  // namespace

int main(int argc, char** argv) { return runProgram(argc, argv, run); }
