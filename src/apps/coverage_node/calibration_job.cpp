#include "coverage_node/calibration_job.h"

#include <ros/init.h>

#include <algorithm>
#include <chrono>
#include <utility>

#include "calibrate_cameras/inputs.h"
#include "calibrate_cameras/outputs.h"
#include "calibrate_cameras/report.h"
#include "common/output.h"
#include "common/program.h"
#include "tartan_calib/io/camchain.h"
#include "tartan_calib/ros/bag_writer.h"
#include "tartan_calib/text.h"

namespace tartan_calib::apps {
namespace {

using guidance::EncodedImage;
using guidance::KeptView;
using Tell = std::function<void(const std::string&)>;

constexpr std::chrono::milliseconds kProgressInterval{500};

bool isStopping() { return !::ros::ok(); }

void throwIfStopping() {
  if (isStopping()) {
    throw pipeline::Cancelled("the calibration was stopped");
  }
}

/// By increasing stamp, as the cameras took them.
void writeBag(const std::vector<KeptView>& views, const std::vector<std::string>& topics, const std::string& path) {
  std::vector<const EncodedImage*> images;
  for (const KeptView& view : views) {
    for (const EncodedImage& image : view.images) {
      images.push_back(&image);
    }
  }
  std::sort(images.begin(), images.end(), [](const EncodedImage* a, const EncodedImage* b) {
    return std::pair(a->stamp_ns, a->camera_index) < std::pair(b->stamp_ns, b->camera_index);
  });
  ros::BagWriter bag(path);
  for (const EncodedImage* image : images) {
    throwIfStopping();
    bag.writeImage(topics[static_cast<std::size_t>(image->camera_index)], image->stamp_ns, image->decode());
  }
  bag.close();
}

std::string progressText(const pipeline::Progress& progress) {
  const std::string camera = progress.camera_index < 0 ? "" : " " + cameraName(progress.camera_index);
  const std::string total = progress.total > 0 ? "/" + std::to_string(progress.total) : "";
  return pipeline::stageName(progress.stage) + camera + ": " + std::to_string(progress.done) + total;
}

pipeline::Listener pipelineListener(const Tell& tell) {
  using Clock = std::chrono::steady_clock;
  pipeline::Listener listener;
  listener.progress = [tell, last = Clock::time_point()](const pipeline::Progress& progress) mutable {
    const bool is_end = progress.total > 0 && progress.done == progress.total;
    if (is_end || Clock::now() - last >= kProgressInterval) {
      last = Clock::now();
      tell(progressText(progress));
    }
  };
  listener.warning = [tell](const std::string& text) { tell("warning: " + text); };
  listener.is_cancelled = isStopping;
  return listener;
}

std::string resultText(const pipeline::CalibrationResult& result) {
  std::vector<std::string> cameras;
  for (std::size_t i = 0; i < result.cameras.size(); ++i) {
    cameras.push_back(format("%s rms %.3f px", cameraName(i).c_str(), result.cameras[i].statistics.rms_px));
  }
  return joined(cameras);
}

}  // namespace

CalibrationJob::CalibrationJob(Arguments arguments, std::string command, JobListener listener)
    : arguments_(std::move(arguments)), command_(std::move(command)), listener_(std::move(listener)) {}

CalibrationJob::~CalibrationJob() { wait(); }

void CalibrationJob::wait() {
  if (thread_.joinable()) {
    thread_.join();
  }
}

bool CalibrationJob::start(std::vector<KeptView> views) {
  if (is_running_.exchange(true)) {
    return false;
  }
  wait();
  thread_ = std::thread([this, views = std::move(views)] {
    try {
      run(views);
    } catch (const pipeline::Cancelled&) {  // the node ends, and with it what listener_ has
      printWarning("the calibration was stopped; " + finished_);
    } catch (const std::exception& error) {
      listener_.progress(std::string("failed: ") + error.what());
    }
    is_running_ = false;
  });
  return true;
}

void CalibrationJob::run(const std::vector<KeptView>& views) {
  const Tell& tell = listener_.progress;
  finished_ = "its views were not written";
  checkFolderOf(arguments_.recording);
  writeBag(views, arguments_.topics, arguments_.recording);
  num_written_ = views.size();
  finished_ = "its views are in " + arguments_.recording + ", no other file was written";
  tell("wrote " + std::to_string(views.size()) + " views to " + arguments_.recording);
  const Inputs inputs = openInputs(arguments_, [&](const std::string& text) { tell("warning: " + text); });
  const pipeline::CalibrationResult result = calibrate(inputs, pipelineListener(tell));
  const OutputFiles files = writeOutputs(result, arguments_, inputs.options, command_);
  finished_ = "its result is in " + files.camchain + " and the files beside it, without a report";
  listener_.camchain(io::camchainText(io::camchain(result)));
  if (arguments_.report) {
    tell("report");
    const ReportFiles report = writeReport(result, inputs, outputPrefix(arguments_), {nullptr, isStopping});
    if (!report.failure.empty()) {
      throwIfStopping();
      tell("warning: no report: " + report.failure);
    }
  }
  tell("finished: " + resultText(result) + ", written to " + files.camchain);
}

}  // namespace tartan_calib::apps
