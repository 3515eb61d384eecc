#include "simulate/simulate.h"

#include <unistd.h>

#include <iostream>

#include "common/interrupt.h"
#include "common/program.h"
#include "common/progress_bar.h"

namespace {

using namespace tartan_calib::apps;

SimulateSummary render(const SimulateOptions& options) {
  ProgressBar bar(isatty(STDOUT_FILENO) != 0);
  SimulateSummary summary = simulate(options, [&bar](std::size_t done, std::size_t total) {
    bar.show(done, total);
    setItemsDone(done, total, "views");
  });
  bar.clear();
  return summary;
}

int run(const std::vector<std::string>& words) {
  if (words.empty()) {
    std::cout << simulateHelp();
    return kWrongUsage;
  }
  const auto options = parseSimulateOptions(words);
  if (!options) {
    std::cout << simulateHelp();
    return kSuccess;
  }
  installInterruptHandler();
  const SimulateSummary summary = render(*options);
  std::cout << "Rendered " << summary.num_images << " images with " << summary.num_visible_corners << " visible of "
            << summary.num_corners << " corners to " << options->output_bag << options->output_dir << '\n'
            << "Target: " << summary.base << "-target.yaml\n"
            << "Truth:  " << summary.base << "-truth-{camchain.yaml,poses.csv,corners.csv}\n";
  return kSuccess;
}

}  // namespace

int main(int argc, char** argv) { return runProgram(argc, argv, run); }
