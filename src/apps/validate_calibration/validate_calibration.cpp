#include "validate_calibration/validate_calibration.h"

#include <unistd.h>

#include <algorithm>
#include <cstdio>

#include "common/detection.h"
#include "common/interrupt.h"
#include "common/output.h"
#include "common/picture_file.h"
#include "common/program.h"
#include "common/progress_bar.h"
#include "common/recording.h"
#include "tartan_calib/io/atomic_file.h"
#include "tartan_calib/io/camchain.h"
#include "tartan_calib/io/corners_csv.h"
#include "validate_calibration/error_picture.h"
#include "validate_calibration/validation.h"

namespace tartan_calib::apps {
namespace {

void checkOutputs(const ValidateOptions& options) {
  if (!options.picture_file.empty()) {
    checkPngName(options.picture_file);
    checkFolderOf(options.picture_file);
  }
  if (!options.errors_file.empty()) {
    checkFolderOf(options.errors_file);
  }
}

std::vector<std::string> topicsOf(const ValidateOptions& options, const io::Camchain& chain) {
  const std::vector<std::string>& topics = options.topics.empty() ? chain.topics : options.topics;
  if (topics.size() != chain.rig.cameras.size()) {
    throw UsageError("exactly one topic per camera is needed: --topics has " + std::to_string(topics.size()) + ", " +
                     options.camchain_file + " has " + std::to_string(chain.rig.cameras.size()) + " cameras");
  }
  if (std::any_of(topics.begin(), topics.end(), [](const std::string& topic) { return topic.empty(); })) {
    throw UsageError("--topics is missing: " + options.camchain_file + " names none");
  }
  return topics;
}

std::vector<pipeline::CameraCorners> cornersOf(const ValidateOptions& options, const io::Camchain& chain,
                                               const target::Target& target, ProgressBar& bar) {
  if (!options.corners_file.empty()) {
    return io::loadCorners(options.corners_file);
  }
  const std::vector<std::string> topics = topicsOf(options, chain);
  pipeline::CalibrateOptions detect;
  detect.num_threads = options.num_threads;
  return detectAll(openRecording(options.recording, topics, options.selection, printWarning), target, detect, bar);
}

void setExpected(const ValidateOptions& options, Validation& validation) {
  const std::vector<double> beside_px = residualsBeside(options.camchain_file, validation.cameras.size());
  for (std::size_t i = 0; i < validation.cameras.size(); ++i) {
    if (options.expected_px) {
      validation.cameras[i].expected_px = options.expected_px;
    } else if (!beside_px.empty()) {
      validation.cameras[i].expected_px = beside_px[i];
    }
  }
}

void writeOutputs(const ValidateOptions& options, const Validation& validation) {
  if (!options.errors_file.empty()) {
    const std::string text = errorsCsv(validation);
    const UninterruptedSection file_is_written_whole;
    io::writeFile(options.errors_file, text);
    setFinishedWork(options.errors_file + " is written");
    std::printf("Errors written to %s\n", options.errors_file.c_str());
  }
  if (!options.picture_file.empty()) {
    setInterruptedStep("before the picture was drawn");
    savePng(options.picture_file, errorPicture(validation));
    std::printf("Picture written to %s\n", options.picture_file.c_str());
  }
}

}  // namespace

void validateCalibration(const ValidateOptions& options) {
  checkOutputs(options);
  const io::Camchain chain = io::loadCamchain(options.camchain_file);
  const target::Target target = openTarget(options.target_file, printWarning);
  ProgressBar bar(isatty(STDOUT_FILENO) != 0);
  const std::vector<pipeline::CameraCorners> corners = cornersOf(options, chain, target, bar);
  Validation validation =
      validate(chain.rig, target, corners, options.approx_sync_ns, [&bar](std::size_t done, std::size_t total) {
        bar.show(done, total);
        setItemsDone(done, total, "views");
      });
  bar.clear();
  setExpected(options, validation);
  std::printf("%s", validationText(validation).c_str());
  std::fflush(stdout);
  writeOutputs(options, validation);
}

}  // namespace tartan_calib::apps
