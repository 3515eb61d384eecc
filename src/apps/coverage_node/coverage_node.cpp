#include "coverage_node/coverage_node.h"

#include <ros/console.h>
#include <ros/init.h>

#include <functional>

#include "common/program.h"
#include "live/detected_image.h"
#include "live/messages.h"
#include "tartan_calib/guidance/blur.h"
#include "tartan_calib/guidance/overlay.h"
#include "tartan_calib/io/target_yaml.h"
#include "tartan_calib/text.h"

namespace tartan_calib::apps {
namespace {

using diagnostic_msgs::DiagnosticStatus;
using guidance::SeenImage;

constexpr std::chrono::milliseconds kIdle{50};
constexpr std::chrono::seconds kDiagnosticsInterval{1};
constexpr std::uint32_t kQueueSize = 2;        ///< of overlays: a slow viewer gets the newest
constexpr std::uint32_t kTextQueueSize = 100;  ///< of lines that none should be lost of

target::Target loadTarget(const std::string& path) {
  const io::LoadedTarget loaded = io::loadTarget(path);
  for (const std::string& warning : loaded.warnings) {
    ROS_WARN("%s", warning.c_str());
  }
  return loaded.target;
}

}  // namespace

CoverageNode::CoverageNode(::ros::NodeHandle node, ::ros::NodeHandle private_node, const CoverageOptions& options)
    : options_(options),
      target_(loadTarget(options.calibration.target_file)),
      detector_(target_, options.calibration.calibrate.detector),
      guide_(target_, options.topics.size(), options.guide),
      advice_(private_node.advertise<std_msgs::String>("advice", kQueueSize, true)),
      diagnostics_(node.advertise<diagnostic_msgs::DiagnosticArray>("/diagnostics", kQueueSize)),
      progress_(private_node.advertise<std_msgs::String>("progress", kTextQueueSize, true)),
      camchain_(private_node.advertise<std_msgs::String>("camchain", 1, true)),
      job_(options.calibration, options.command,
           {[this](const std::string& line) {
              ROS_INFO("%s", line.c_str());
              progress_.publish(textMessage(line));
            },
            [this](const std::string& yaml) { camchain_.publish(textMessage(yaml)); }}),
      input_(node, options.topics, options.input) {
  for (std::size_t i = 0; i < options.topics.size(); ++i) {
    cameras_.push_back({CameraMonitor(static_cast<int>(i), options.topics[i]),
                        private_node.advertise<sensor_msgs::Image>(cameraName(i) + "/overlay", kQueueSize),
                        0,
                        {},
                        {}});
  }
  services_.push_back(private_node.advertiseService("calibrate", &CoverageNode::onCalibrate, this));
  services_.push_back(private_node.advertiseService("reset", &CoverageNode::onReset, this));
}

CoverageNode::~CoverageNode() {
  for (::ros::ServiceServer& service : services_) {
    service.shutdown();
  }
}

void CoverageNode::run() {
  last_diagnostics_ = Clock::now();
  while (::ros::ok()) {
    const std::vector<ArrivedImage> images = input_.take(kIdle);
    if (!images.empty()) {
      process(images);
    }
    if (Clock::now() - last_diagnostics_ >= kDiagnosticsInterval) {
      publishDiagnostics();
    }
  }
  job_.wait();
  if (job_.numWritten() < guide_.kept().size()) {
    printWarning("stopped with " + std::to_string(guide_.kept().size()) + " views, of which " +
                 std::to_string(job_.numWritten()) + " were written; ~calibrate writes them");
  }
}

std::vector<SeenImage> CoverageNode::detect(const std::vector<ArrivedImage>& images) {
  std::vector<SeenImage> seen;
  for (DetectedImage& image : detectImages(detector_, images)) {
    CameraMonitor& monitor = cameras_[static_cast<std::size_t>(image.camera_index)].monitor;
    if (image.gray.empty()) {
      monitor.countUnreadable(image.unreadable_reason);
      continue;
    }
    monitor.countProcessed();
    const auto blur_px = guidance::edgeBlur(image.gray, image.corners, target_);
    seen.push_back({image.camera_index, image.stamp_ns, image.gray, std::move(image.corners), blur_px});
  }
  return seen;
}

void CoverageNode::process(const std::vector<ArrivedImage>& images) {
  const std::vector<SeenImage> seen = detect(images);
  if (seen.empty()) {
    return;
  }
  const std::lock_guard<std::mutex> lock(guide_mutex_);
  const std::vector<guidance::Decision> decisions = guide_.offer(seen);
  updateSolve();
  const guidance::Advice advice = guide_.advise(seen);
  advice_.publish(textMessage(advice.text));
  is_waiting_ = false;
  for (std::size_t i = 0; i < seen.size(); ++i) {
    CameraState& camera = cameras_[static_cast<std::size_t>(seen[i].camera_index)];
    camera.num_corners = seen[i].corners.size();
    camera.blur_px = seen[i].blur_px;
    camera.decision = decisions[i];
    if (camera.overlay.getNumSubscribers() > 0) {
      publishOverlay(seen[i], advice, decisions[i]);
    }
  }
}

void CoverageNode::updateSolve() {
  if (solve_.valid() && solve_.wait_for(std::chrono::seconds(0)) == std::future_status::ready) {
    if (const auto rig = solve_.get()) {
      guide_.adopt(*rig);
    }
  }
  if (!solve_.valid()) {
    if (const auto solve = guide_.nextSolve([] { return !::ros::ok(); })) {
      solve_ = std::async(std::launch::async, *solve);
    }
  }
}

void CoverageNode::publishOverlay(const SeenImage& image, const guidance::Advice& advice, guidance::Decision decision) {
  const std::string name = cameraName(image.camera_index);
  guidance::Overlay overlay;
  overlay.coverage = guide_.coverage(image.camera_index);
  overlay.corners = image.corners;
  overlay.advice = advice.text;
  overlay.status = format("%s: %zu corners, %zu views kept. This view: %s", name.c_str(), image.corners.size(),
                          guide_.numKept(image.camera_index), guidance::decisionText(decision).c_str());
  if (advice.candidate && guide_.rig()) {
    overlay.outline = guidance::boardOutline(guide_.rig()->cameras[static_cast<std::size_t>(image.camera_index)],
                                             guide_.targetPoints(), advice.candidate->T_rig_target);
  }
  if (decision == guidance::Decision::kOtherSize) {
    overlay.coverage = nullptr;
    overlay.warning = "IMAGE SIZE CHANGED: reset to start over";
  } else if (image.blur_px && *image.blur_px > options_.guide.max_blur_px) {
    overlay.warning = format("BLURRED (%.1f px): move slowly, add light", *image.blur_px);
  }
  cameras_[static_cast<std::size_t>(image.camera_index)].overlay.publish(
      colourMessage(guidance::drawOverlay(image.gray, overlay, options_.overlay_width_px), image.stamp_ns, name));
}

void CoverageNode::publishDiagnostics() {
  const double interval_s = std::chrono::duration<double>(Clock::now() - last_diagnostics_).count();
  last_diagnostics_ = Clock::now();
  diagnostic_msgs::DiagnosticArray array;
  array.header.stamp = ::ros::Time::now();
  const std::lock_guard<std::mutex> lock(guide_mutex_);
  for (std::size_t i = 0; i < cameras_.size(); ++i) {
    array.status.push_back(status(static_cast<int>(i), interval_s));
  }
  diagnostics_.publish(array);
  if (is_waiting_) {
    advice_.publish(textMessage(guide_.advise({}).text));
  }
  is_waiting_ = true;
}

DiagnosticStatus CoverageNode::status(int camera_index, double interval_s) {
  CameraState& camera = cameras_[static_cast<std::size_t>(camera_index)];
  DiagnosticStatus status = camera.monitor.status(input_.counts(camera_index), interval_s);
  if (camera.decision) {
    const bool needs_care =
        *camera.decision == guidance::Decision::kBlurred || *camera.decision == guidance::Decision::kOtherSize;
    worsen(status, needs_care ? DiagnosticStatus::WARN : DiagnosticStatus::OK, guidance::decisionText(*camera.decision));
  }
  addValue(status, "corners", std::to_string(camera.num_corners));
  addValue(status, "blur [px]", camera.blur_px ? format("%.2f", *camera.blur_px) : "unknown");
  addValue(status, "views kept", std::to_string(guide_.numKept(camera_index)));
  addValue(status, "calibrated", guide_.rig() ? "yes" : "no");
  return status;
}

bool CoverageNode::onCalibrate(std_srvs::Trigger::Request& /*request*/, std_srvs::Trigger::Response& response) {
  const std::lock_guard<std::mutex> lock(guide_mutex_);
  if (guide_.kept().empty()) {
    response.message = "no view is kept yet: " + guide_.advise({}).text;
    return true;
  }
  response.success = job_.start(guide_.kept()) ? 1 : 0;
  response.message = response.success != 0
                         ? "calibrating " + std::to_string(guide_.kept().size()) + " views, to be written to " +
                               options_.calibration.recording + "; see ~progress"
                         : "the last calibration still runs; see ~progress";
  return true;
}

bool CoverageNode::onReset(std_srvs::Trigger::Request& /*request*/, std_srvs::Trigger::Response& response) {
  const std::lock_guard<std::mutex> lock(guide_mutex_);
  const std::size_t num_views = guide_.kept().size();
  solve_ = {};  // waits for it: what it finds is about the old views
  guide_ = guidance::Guide(target_, cameras_.size(), options_.guide);
  response.success = 1;
  response.message = "forgot " + std::to_string(num_views) + " views";
  return true;
}

}  // namespace tartan_calib::apps
