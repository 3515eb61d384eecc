#pragma once

#include <diagnostic_msgs/DiagnosticArray.h>
#include <ros/node_handle.h>

#include <chrono>
#include <deque>
#include <string>
#include <vector>

#include "live/camera_monitor.h"
#include "live/detected_image.h"
#include "live/image_input.h"
#include "live/parameters.h"
#include "tartan_calib/calibration/validate.h"
#include "tartan_calib/detection/target_detector.h"
#include "tartan_calib/io/camchain.h"
#include "tartan_calib/target/target.h"

namespace tartan_calib::apps {

/// What the validation node is asked to do.
struct ValidationOptions {
  io::Camchain camchain;
  target::Target target;
  std::vector<std::string> topics;  ///< one per camera of the camchain
  guidance::NewestViewOptions input;
  double max_rms_px = 1.0;  ///< above it a camera's status is a warning
  int overlay_width_px = 800;
};

/// Throws UsageError and InputError.
ValidationOptions validationOptions(Parameters parameters, const ::ros::NodeHandle& node);

/// Watches cameras whose calibration is given and tells how far the corners of a board are from where it puts them.
/// docs/live.md describes topics and parameters.
class ValidationNode {
 public:
  ValidationNode(::ros::NodeHandle node, ::ros::NodeHandle private_node, const ValidationOptions& options);

  /// Until the node is shut down. Callbacks are served by other threads.
  void run();

 private:
  using Clock = std::chrono::steady_clock;

  struct CameraState {
    CameraMonitor monitor;
    ::ros::Publisher overlay;
    std::deque<calibration::ImageErrors> alone;     ///< of recent images: with the pose that suits this camera best
    std::deque<calibration::ImageErrors> together;  ///< with one pose for all cameras
  };

  void process(const std::vector<ArrivedImage>& images);
  void publishOverlay(const DetectedImage& image, const calibration::ViewErrors& errors);
  void publishDiagnostics();
  diagnostic_msgs::DiagnosticStatus status(int camera_index, double interval_s);

  ValidationOptions options_;
  std::vector<Eigen::Vector3d> target_points_;
  detection::TargetDetector detector_;
  std::vector<CameraState> cameras_;
  Clock::time_point last_diagnostics_;
  ::ros::Publisher diagnostics_;
  ImageInput input_;
};

}  // namespace tartan_calib::apps
