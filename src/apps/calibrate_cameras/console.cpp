#include "calibrate_cameras/console.h"

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <string>

#include "common/interrupt.h"
#include "common/program.h"
#include "tartan_calib/io/results_text.h"
#include "tartan_calib/text.h"

namespace tartan_calib::apps {
namespace {

constexpr const char* kDots = "..................................................................";

struct ParameterText {
  std::string projection;
  std::string distortion;
};

ParameterText parameterText(const camera::CameraModel& model) {
  const Eigen::VectorXd parameters = camera::parameters(model);
  const int num_intrinsics = camera::numIntrinsics(model);
  return {io::arrayText(parameters.head(num_intrinsics)),
          io::arrayText(parameters.tail(parameters.size() - num_intrinsics))};
}

bool hasUsedCorner(const observation::View& view) {
  return std::any_of(view.cameras.begin(), view.cameras.end(), [](const observation::CameraView& image) {
    return std::any_of(image.corners.begin(), image.corners.end(), [](const auto& corner) { return corner.used; });
  });
}

int numRejected(const calibration::Solution& solution) {
  int rejected = 0;
  for (const calibration::CornerCounts& counts : solution.counts) {
    rejected += counts.rejected();
  }
  return rejected;
}

void printQuality(const pipeline::CalibrationResult& result) {
  constexpr double kDegreesPerRadian = 57.29577951308232;
  for (std::size_t i = 0; i < result.cameras.size(); ++i) {
    const pipeline::CameraReport& camera = result.cameras[i];
    const calibration::CameraStatistics& statistics = camera.statistics;
    std::printf("cam%zu: rms %.4f px, median %.4f px over %d corners in %zu of %zu images, to %.1f degrees from the axis\n",
                i, statistics.rms_px, statistics.median_px, statistics.num_corners, camera.num_images_used,
                camera.num_images, statistics.max_polar_angle_rad * kDegreesPerRadian);
  }
}

}  // namespace

Console::Console(const Inputs& inputs) : inputs_(inputs), bar_(isatty(STDOUT_FILENO) != 0) {}

pipeline::Listener Console::listener() {
  pipeline::Listener listener;
  listener.progress = [this](const pipeline::Progress& progress) { onProgress(progress); };
  listener.camera_detected = [this](int index, const pipeline::CameraCorners& corners) { onDetected(index, corners); };
  listener.camera_started = [this](int /*index*/, const camera::Camera& camera) { onStarted(camera); };
  listener.rig_started = [this](const calibration::Problem& problem) { onRigStarted(problem); };
  listener.round_finished = [this](const pipeline::RoundSummary& round) { onRoundFinished(round); };
  listener.warning = [this](const std::string& text) {
    bar_.clear();
    printWarning(text);
  };
  return listener;
}

void Console::printCameraHeader(int camera_index, std::size_t num_images) {
  const auto at = static_cast<std::size_t>(camera_index);
  std::printf("Initializing cam%d:\n", camera_index);
  std::printf("\tCamera model:\t  %s\n", inputs_.options.models[at].c_str());
  std::printf("\tDataset:          %s\n", inputs_.dataset.c_str());
  std::printf("\tTopic:            %s\n", inputs_.topics[at].c_str());
  std::printf("\tNumber of images: %zu\n", num_images);
}

/// Round 0 is the detection; the search for more corners begins the next round.
void Console::noteStep(const pipeline::Progress& progress) {
  if (progress.stage == pipeline::Stage::kRecover) {
    round_ = num_rounds_finished_ + 1;
  }
  const std::string camera = progress.camera_index < 0 ? "" : " " + cameraName(progress.camera_index);
  setInterruptedStep("in round " + std::to_string(round_) + " (" + pipeline::stageName(progress.stage) + camera + ")");
}

void Console::onProgress(const pipeline::Progress& progress) {
  noteStep(progress);
  const bool has_images = progress.stage == pipeline::Stage::kDetect || progress.stage == pipeline::Stage::kRecover;
  if (!has_images) {
    if (progress.done == progress.total) {
      bar_.clear();
      step_.clear();
    } else {
      showStep(pipeline::stageName(progress.stage), progress.done, progress.total);
    }
    return;
  }
  step_.clear();
  if (progress.stage == pipeline::Stage::kDetect && progress.done == 0) {
    printCameraHeader(progress.camera_index, progress.total);
    std::printf("Extracting calibration target corners\n");
    std::fflush(stdout);
  }
  bar_.show(progress.done, progress.total);
}

void Console::showStep(const std::string& step, std::size_t done, std::size_t total) {
  if (step != step_) {
    bar_.clear();
    bar_.show(0, 0);
    step_ = step;
  }
  if (total > 0) {
    bar_.show(done, total);
  } else {
    bar_.showElapsed(step);
  }
}

void Console::onDetected(int camera_index, const pipeline::CameraCorners& corners) {
  bar_.clear();
  if (!inputs_.corners.empty()) {
    printCameraHeader(camera_index, corners.num_images);
  }
  std::printf("\n  Extracted corners for %zu images (of %zu images)\n", corners.images.size(), corners.num_images);
  std::fflush(stdout);
}

void Console::onStarted(const camera::Camera& camera) {
  const ParameterText text = parameterText(camera.model);
  std::printf("\tProjection initialized to: %s\n", text.projection.c_str());
  std::printf("\tDistortion initialized to: %s\n", text.distortion.c_str());
  std::fflush(stdout);
}

void Console::onRigStarted(const calibration::Problem& problem) {
  const std::vector<calibration::RigCamera>& cameras = problem.rig.cameras;
  std::printf("initializing initial guesses\n");
  for (std::size_t i = 1; i < cameras.size(); ++i) {
    std::printf("\t initializing camera pair (%zu,%zu)...  \n", i - 1, i);
  }
  for (std::size_t i = 1; i < cameras.size(); ++i) {
    const geometry::Rigid3 T_cam_previous = cameras[i].T_cam_rig * cameras[i - 1].T_cam_rig.inverse();
    std::printf("initialized baseline between cam%zu and cam%zu to:\n%s\n", i - 1, i,
                io::matrixText(T_cam_previous.matrix()).c_str());
  }
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    const ParameterText text = parameterText(cameras[i].camera.model);
    std::printf("initialized cam%zu to:\n\t projection cam%zu: %s\n\t distortion cam%zu: %s\n", i, i,
                text.projection.c_str(), i, text.distortion.c_str());
  }
  std::printf("initializing calibrator\nstarting calibration...\n");
  std::fflush(stdout);
}

void Console::onRoundFinished(const pipeline::RoundSummary& round) {
  num_rounds_finished_ = round.round;
  bar_.clear();
  std::printf("round %d: %d corners, %d gained, %d lost, rms %.4f px, model moved %.4f px\n", round.round, round.corners,
              round.gained, round.lost, round.rms_px, round.model_change_px);
  std::fflush(stdout);
}

void Console::printResult(const pipeline::CalibrationResult& result) {
  const calibration::Solution& solution = result.solution;
  const auto num_used = std::count_if(solution.views.begin(), solution.views.end(), hasUsedCorner);
  const std::size_t num_views = solution.views.size() + static_cast<std::size_t>(result.num_dropped_views);
  std::printf("\nAll views have been processed.\n\n");
  if (inputs_.options.solve.final_filtering) {
    std::printf("Starting final outlier filtering...\n");  // scripts wait for it; each solve ended with that
  }
  std::printf("%s\n\nCalibration complete.\n\n", kDots);
  printWarning("Removed " + std::to_string(numRejected(solution)) + " outlier corners.");
  std::printf("\nProcessed %zu images with %td images used\n", num_views, num_used);
  std::printf("%s\n", io::resultsText(result).c_str());
  printQuality(result);
  std::printf("\n");
  std::fflush(stdout);
}

void Console::printFiles(const OutputFiles& files) {
  std::printf("Results written to:\n");
  std::printf("  Saving camera chain calibration to file: %s\n", files.camchain.c_str());
  std::printf("  Detailed results written to file: %s\n", files.results.c_str());
  std::printf("  Complete record written to file: %s\n", files.calibration.c_str());
  std::fflush(stdout);
}

void Console::printExports(const OutputFiles& files) {
  if (!files.poses.empty()) {
    std::printf("Exporting poses...\n  Poses written to %s\n", files.poses.c_str());
  }
  if (!files.corners.empty()) {
    std::printf("Exporting corners...\n  Corners written to %s\n", files.corners.c_str());
  }
  std::fflush(stdout);
}

void Console::printReport(const ReportFiles& report) {
  bar_.clear();
  if (!report.failure.empty()) {
    printWarning("there is no report: " + report.failure);
  } else {
    std::printf("  Report written to %s\n  Report written to %s\n", report.pdf.c_str(), report.html.c_str());
  }
  if (!report.verdict) {
    return;
  }
  std::printf("\nVerdict: %s\n", report::gradeName(report.verdict->grade).c_str());
  for (const std::string& fact : report.verdict->facts) {
    std::printf("  %s\n", fact.c_str());
  }
  for (const report::Reason& reason : report.verdict->reasons) {
    std::printf("  %s: %s\n", report::gradeName(reason.grade).c_str(), reason.text.c_str());
  }
  std::fflush(stdout);
}

void Console::printTimes(const pipeline::CalibrationResult& result) {
  for (const pipeline::StageTime& time : result.times) {
    const std::string camera = time.camera_index < 0 ? "" : " cam" + std::to_string(time.camera_index);
    std::printf("%10.3f s  %s%s\n", time.seconds, pipeline::stageName(time.stage).c_str(), camera.c_str());
  }
}

}  // namespace tartan_calib::apps
