#include "validation_node/validation_node.h"

#include <ros/init.h>

#include <iterator>
#include <limits>
#include <map>

#include "common/program.h"
#include "live/detected_image.h"
#include "live/messages.h"
#include "tartan_calib/guidance/error_overlay.h"
#include "tartan_calib/io/target_yaml.h"
#include "tartan_calib/text.h"

namespace tartan_calib::apps {
namespace {

using calibration::ImageErrors;
using diagnostic_msgs::DiagnosticStatus;

constexpr std::chrono::milliseconds kIdle{50};
constexpr std::chrono::seconds kDiagnosticsInterval{1};
constexpr std::uint32_t kQueueSize = 2;     ///< a slow viewer gets the newest
constexpr std::size_t kRecentImages = 100;  ///< per camera, that the statistics are about

/// The largest scale at which error lines stay shorter than the distance of corners: for errors of that size.
constexpr double kErrorLine_px = 40.0;

const ImageErrors* errorsOf(const std::vector<ImageErrors>& images, int camera_index) {
  for (const ImageErrors& image : images) {
    if (image.camera_index == camera_index) {
      return &image;
    }
  }
  return nullptr;
}

void remember(const std::vector<ImageErrors>& images, int camera_index, std::deque<ImageErrors>& recent) {
  if (const ImageErrors* image = errorsOf(images, camera_index)) {
    recent.push_back(*image);
    if (recent.size() > kRecentImages) {
      recent.pop_front();
    }
  }
}

calibration::CameraErrors summary(const std::deque<ImageErrors>& recent) {
  return calibration::summarizeErrors({recent.begin(), recent.end()});
}

void addErrors(diagnostic_msgs::DiagnosticStatus& status, const std::string& kind, const calibration::CameraErrors& errors) {
  addValue(status, kind + ": rms [px]", format("%.3f", errors.errors.rms_px));
  addValue(status, kind + ": median [px]", format("%.3f", errors.errors.median_px));
  addValue(status, kind + ": 95 % below [px]", format("%.3f", errors.errors.percentile95_px));
  addValue(status, kind + ": mean u, v [px]", format("%.3f, %.3f", errors.errors.mean_px.x(), errors.errors.mean_px.y()));
}

}  // namespace

ValidationOptions validationOptions(Parameters parameters, const ::ros::NodeHandle& node) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  constexpr double kNsPerSecond = 1e9;
  constexpr double kMaxSync_s = 10.0;
  constexpr double kMinWidth_px = 160.0;
  constexpr double kMaxWidth_px = 8192.0;
  ValidationOptions options;
  const std::string file = parameters.text("camchain");
  options.camchain = io::loadCamchain(file);
  options.target = io::loadTarget(parameters.text("target")).target;
  for (const std::string& topic : parameters.words("topics", options.camchain.topics)) {
    options.topics.push_back(topic.empty() ? topic : node.resolveName(topic));
  }
  if (options.topics.size() != options.camchain.rig.cameras.size() || options.topics.front().empty()) {
    throw UsageError("parameter ~topics must name a topic for each of the " +
                     std::to_string(options.camchain.rig.cameras.size()) + " cameras in " + file);
  }
  options.input.sync_ns = static_cast<std::int64_t>(kNsPerSecond * parameters.number("approx_sync", 0.02, 0.0, kMaxSync_s));
  options.input.max_rate_hz = parameters.number("max_rate", options.input.max_rate_hz, 0.0, kInfinity);
  options.max_rms_px = parameters.number("max_rms_px", options.max_rms_px, 0.0, kInfinity);
  options.overlay_width_px =
      static_cast<int>(parameters.number("overlay_width", options.overlay_width_px, kMinWidth_px, kMaxWidth_px));
  parameters.checkAllKnown();
  return options;
}

ValidationNode::ValidationNode(::ros::NodeHandle node, ::ros::NodeHandle private_node, const ValidationOptions& options)
    : options_(options),
      target_points_(target::cornerPoints(options.target)),
      detector_(options.target),
      diagnostics_(node.advertise<diagnostic_msgs::DiagnosticArray>("/diagnostics", kQueueSize)),
      input_(node, options.topics, options.input) {
  for (std::size_t i = 0; i < options.topics.size(); ++i) {
    cameras_.push_back({CameraMonitor(static_cast<int>(i), options.topics[i]),
                        private_node.advertise<sensor_msgs::Image>(cameraName(i) + "/overlay", kQueueSize),
                        {},
                        {}});
  }
}

void ValidationNode::run() {
  last_diagnostics_ = Clock::now();
  while (::ros::ok()) {
    process(input_.take(kIdle));
    if (Clock::now() - last_diagnostics_ >= kDiagnosticsInterval) {
      publishDiagnostics();
    }
  }
}

void ValidationNode::process(const std::vector<ArrivedImage>& images) {
  observation::View view;
  const std::vector<DetectedImage> detected = detectImages(detector_, images);
  for (const DetectedImage& image : detected) {
    const auto at = static_cast<std::size_t>(image.camera_index);
    const camera::Camera& camera = options_.camchain.rig.cameras[at].camera;
    if (image.gray.empty()) {
      cameras_[at].monitor.countUnreadable(image.unreadable_reason);
    } else if (image.gray.cols != camera.width || image.gray.rows != camera.height) {
      cameras_[at].monitor.countUnreadable(
          format("%dx%d, but the camchain is for %dx%d", image.gray.cols, image.gray.rows, camera.width, camera.height));
    } else {
      cameras_[at].monitor.countProcessed();
      view.cameras.push_back({image.camera_index, image.stamp_ns, image.corners});
    }
  }
  if (view.cameras.empty()) {
    return;
  }
  view.stamp_ns = view.cameras.front().stamp_ns;
  const calibration::ViewErrors errors = calibration::validateView(options_.camchain.rig, target_points_, view);
  for (const observation::CameraView& seen : view.cameras) {
    CameraState& camera = cameras_[static_cast<std::size_t>(seen.camera_index)];
    remember(errors.alone, seen.camera_index, camera.alone);
    remember(errors.together, seen.camera_index, camera.together);
  }
  for (const DetectedImage& image : detected) {
    if (!image.gray.empty() && cameras_[static_cast<std::size_t>(image.camera_index)].overlay.getNumSubscribers() > 0) {
      publishOverlay(image, errors);
    }
  }
}

void ValidationNode::publishOverlay(const DetectedImage& image, const calibration::ViewErrors& errors) {
  const std::string name = cameraName(image.camera_index);
  CameraState& camera = cameras_[static_cast<std::size_t>(image.camera_index)];
  const bool has_rig = cameras_.size() > 1;
  guidance::ErrorOverlay overlay;
  overlay.full_scale_px = options_.max_rms_px;
  overlay.magnification = kErrorLine_px / options_.max_rms_px;
  overlay.errors = errorsOf(has_rig ? errors.together : errors.alone, image.camera_index);
  const ImageErrors* alone = errorsOf(errors.alone, image.camera_index);
  overlay.headline = alone == nullptr
                         ? name + ": no board that the calibration explains"
                         : format("%s: rms %.2f px", name.c_str(), calibration::summarizeCorners(alone->corners).rms_px);
  if (has_rig && alone != nullptr && overlay.errors != nullptr) {
    overlay.headline +=
        format(", %.2f px with the other cameras", calibration::summarizeCorners(overlay.errors->corners).rms_px);
  }
  overlay.status = format("%zu corners, rms %.2f px over %zu images", image.corners.size(),
                          summary(camera.alone).errors.rms_px, camera.alone.size());
  camera.overlay.publish(
      colourMessage(guidance::drawErrors(image.gray, overlay, options_.overlay_width_px), image.stamp_ns, name));
}

void ValidationNode::publishDiagnostics() {
  const double interval_s = std::chrono::duration<double>(Clock::now() - last_diagnostics_).count();
  last_diagnostics_ = Clock::now();
  diagnostic_msgs::DiagnosticArray array;
  array.header.stamp = ::ros::Time::now();
  for (std::size_t i = 0; i < cameras_.size(); ++i) {
    array.status.push_back(status(static_cast<int>(i), interval_s));
  }
  diagnostics_.publish(array);
}

DiagnosticStatus ValidationNode::status(int camera_index, double interval_s) {
  CameraState& camera = cameras_[static_cast<std::size_t>(camera_index)];
  DiagnosticStatus status = camera.monitor.status(input_.counts(camera_index), interval_s);
  const calibration::CameraErrors alone = summary(camera.alone);
  const calibration::CameraErrors together = summary(camera.together);
  if (alone.errors.rms_px > options_.max_rms_px) {
    worsen(status, DiagnosticStatus::WARN, format("intrinsics: rms %.2f px", alone.errors.rms_px));
  } else if (together.errors.rms_px > options_.max_rms_px) {
    worsen(status, DiagnosticStatus::WARN, format("extrinsics: rms %.2f px", together.errors.rms_px));
  } else {
    worsen(status, DiagnosticStatus::OK, camera.alone.empty() ? "no board yet" : format("rms %.2f px", alone.errors.rms_px));
  }
  addErrors(status, "intrinsics alone", alone);
  if (cameras_.size() > 1) {
    addErrors(status, "with the other cameras", together);
  }
  addValue(status, "images", std::to_string(alone.num_images));
  addValue(status, "wrong corners", std::to_string(alone.num_wrong));
  return status;
}

}  // namespace tartan_calib::apps
