#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <string>
#include <vector>

#include "calibrate_cameras/arguments.h"
#include "calibrate_cameras/outputs.h"
#include "calibrate_cameras/session.h"
#include "common/interrupt.h"
#include "common/program.h"
#include "common/progress_bar.h"
#include "tartan_calib/io/atomic_file.h"
#include "tartan_calib/io/camchain.h"
#include "tartan_calib/io/results_text.h"
#include "tartan_calibrate/debug_pictures.h"
#include "tartan_calibrate/tartan_flags.h"

namespace {

using namespace tartan_calib;
namespace fs = std::filesystem;

void makeFolder(const std::string& flag, const std::string& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  const std::string problem = error ? error.message() : access(folder.c_str(), W_OK) != 0 ? std::strerror(errno) : "";
  if (!problem.empty()) {
    throw InputError("folder " + folder + " of --" + flag + " cannot be made or written to (" + problem +
                     "): give another one");
  }
}

int numUsed(const pipeline::CalibrationResult& result, std::size_t camera_index) {
  return result.cameras[camera_index].statistics.num_corners;
}

apps::SessionHooks hooksFor(const apps::TartanCommand& command) {
  const std::string prefix = (fs::path(command.save_dir) / command.log_dest).string();
  apps::SessionHooks hooks;
  hooks.detection_solved = [prefix](const apps::Inputs&, const pipeline::CalibrationResult& result) {
    const apps::UninterruptedSection files_are_written_whole;
    io::writeFile(prefix + "0-camchain.yaml", io::camchainText(io::camchain(result)));
    io::writeFile(prefix + "0-results-cam.txt", io::resultsText(result));
    apps::setFinishedWork(prefix + "0-camchain.yaml and " + prefix + "0-results-cam.txt are written");
    for (std::size_t i = 0; i < result.cameras.size(); ++i) {
      std::printf("Started tartan calib with %d points.\n", numUsed(result, i));
    }
    std::fflush(stdout);
  };
  hooks.finished = [command](const apps::Inputs& inputs, const pipeline::CalibrationResult& result) {
    for (std::size_t i = 0; i < result.cameras.size(); ++i) {
      std::printf("Ended tartan calib with %d corners.\n", numUsed(result, i));
    }
    if (command.debug_modes.empty()) {
      return;
    }
    const std::string& folder = command.debug_image_dir.empty() ? command.save_dir : command.debug_image_dir;
    std::printf("Writing the pictures of --debug-modes to %s\n", folder.c_str());
    std::fflush(stdout);
    apps::ProgressBar bar(isatty(STDOUT_FILENO) != 0);
    apps::setInterruptedStep("in the pictures of --debug-modes");
    apps::writeDebugPictures(inputs, result, command.debug_modes, folder,
                             [&bar](std::size_t done, std::size_t total) { bar.show(done, total); });
    bar.clear();
  };
  return hooks;
}

int run(const std::vector<std::string>& words) {
  const apps::TartanCommand command = apps::translateTartanFlags(words);
  if (words.empty() || command.help) {
    std::fputs(apps::tartanHelpText().c_str(), stdout);
    return words.empty() ? apps::kWrongUsage : apps::kSuccess;
  }
  apps::Arguments arguments = apps::parseArguments(command.words);
  for (const std::string& note : command.notes) {
    apps::printWarning(note);
  }
  const fs::path prefix = fs::path(command.save_dir) / (command.log_dest + "1");
  makeFolder("save_dir", command.save_dir);
  if (fs::path(command.log_dest).has_parent_path()) {
    makeFolder("log_dest", prefix.parent_path().string());
  }
  if (!command.debug_modes.empty() && !command.debug_image_dir.empty()) {
    makeFolder("debug_image_dir", command.debug_image_dir);
  }
  arguments.output_prefix = prefix.string();
  const std::string detection_alone = (fs::path(command.save_dir) / (command.log_dest + "0")).string();
  apps::checkInputsStay(arguments, {detection_alone + "-camchain.yaml", detection_alone + "-results-cam.txt"});
  apps::runSession(arguments, apps::commandText("tartan_calibrate", words), hooksFor(command));
  return apps::kSuccess;
}

}  // namespace

int main(int argc, char** argv) {
  apps::installInterruptHandler();
  return apps::runProgram(argc, argv, run);
}
