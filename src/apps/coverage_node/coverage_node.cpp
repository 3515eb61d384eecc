#include "coverage_node/coverage_node.h"

#include <ros/console.h>
#include <ros/init.h>
#include <ros/this_node.h>

#include <functional>

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
      cameras_(options.topics.size()),
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
  for (std::size_t i = 0; i < cameras_.size(); ++i) {
    cameras_[i].overlay = private_node.advertise<sensor_msgs::Image>(cameraName(i) + "/overlay", kQueueSize);
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
}

std::vector<SeenImage> CoverageNode::detect(const std::vector<ArrivedImage>& images) {
  std::vector<std::future<SeenImage>> detections;
  for (const ArrivedImage& image : images) {
    detections.push_back(std::async(std::launch::async, [this, &image] {
      SeenImage seen{image.camera_index, image.stamp_ns, image.decode(), {}, {}};
      seen.corners = detector_.detect(seen.gray).corners;
      seen.blur_px = guidance::edgeBlur(seen.gray, seen.corners, target_);
      return seen;
    }));
  }
  std::vector<SeenImage> all;
  for (std::size_t i = 0; i < images.size(); ++i) {
    CameraState& camera = cameras_[static_cast<std::size_t>(images[i].camera_index)];
    try {
      all.push_back(detections[i].get());
      ++camera.num_processed;
    } catch (const std::exception& error) {  // one broken image must not end the session
      ++camera.num_unreadable;
      camera.unreadable_reason = error.what();
    }
  }
  return all;
}

void CoverageNode::process(const std::vector<ArrivedImage>& images) {
  const std::vector<SeenImage> seen = detect(images);
  if (seen.empty()) {
    return;
  }
  const std::lock_guard<std::mutex> lock(guide_mutex_);
  const guidance::Decision decision = guide_.offer(seen);
  updateSolve();
  const guidance::Advice advice = guide_.advise(seen);
  advice_.publish(textMessage(advice.text));
  for (const SeenImage& image : seen) {
    CameraState& camera = cameras_[static_cast<std::size_t>(image.camera_index)];
    camera.seen = image;
    camera.decision = guidance::decisionText(decision);
    if (camera.overlay.getNumSubscribers() > 0) {
      publishOverlay(image, advice, decision);
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
}

DiagnosticStatus CoverageNode::status(int camera_index, double interval_s) {
  const auto at = static_cast<std::size_t>(camera_index);
  CameraState& camera = cameras_[at];
  const InputCounts counts = input_.counts(camera_index);
  DiagnosticStatus status;
  status.name = ::ros::this_node::getName() + ": " + cameraName(camera_index);
  status.hardware_id = options_.topics[at];

  if (counts.received == camera.num_received_before) {
    worsen(status, DiagnosticStatus::STALE, "no images on " + options_.topics[at]);
  }
  if (camera.num_unreadable > camera.num_unreadable_before) {
    worsen(status, DiagnosticStatus::ERROR, "broken image: " + camera.unreadable_reason);
  }
  if (camera.decision == guidance::decisionText(guidance::Decision::kOtherSize) ||
      camera.decision == guidance::decisionText(guidance::Decision::kBlurred)) {
    worsen(status, DiagnosticStatus::WARN, camera.decision);
  }
  worsen(status, DiagnosticStatus::OK, camera.decision);

  const auto rate = static_cast<double>(camera.num_processed - camera.num_processed_before) / interval_s;
  addValue(status, "processed rate [Hz]", format("%.1f", rate));
  addValue(status, "received", std::to_string(counts.received));
  addValue(status, "dropped", std::to_string(counts.dropped));
  addValue(status, "unreadable", std::to_string(camera.num_unreadable));
  addValue(status, "corners", std::to_string(camera.seen ? camera.seen->corners.size() : 0));
  addValue(status, "blur [px]", camera.seen && camera.seen->blur_px ? format("%.2f", *camera.seen->blur_px) : "unknown");
  addValue(status, "views kept", std::to_string(guide_.numKept(camera_index)));
  addValue(status, "calibrated", guide_.rig() ? "yes" : "no");
  camera.num_received_before = counts.received;
  camera.num_processed_before = camera.num_processed;
  camera.num_unreadable_before = camera.num_unreadable;
  return status;
}

bool CoverageNode::onCalibrate(std_srvs::Trigger::Request& /*request*/, std_srvs::Trigger::Response& response) {
  const std::lock_guard<std::mutex> lock(guide_mutex_);
  if (guide_.kept().empty()) {
    response.message = "no view is kept yet: " + guide_.advise({}).text;
    return true;
  }
  response.success = job_.start(guide_.kept()) ? 1 : 0;
  response.message = response.success != 0 ? "calibrating " + std::to_string(guide_.kept().size()) + " views, written to " +
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
