#pragma once

#include <diagnostic_msgs/DiagnosticArray.h>
#include <ros/node_handle.h>
#include <std_srvs/Trigger.h>

#include <chrono>
#include <future>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "coverage_node/calibration_job.h"
#include "coverage_node/options.h"
#include "live/camera_monitor.h"
#include "live/image_input.h"
#include "tartan_calib/detection/target_detector.h"
#include "tartan_calib/guidance/guide.h"

namespace tartan_calib::apps {

/// Watches cameras, says where to hold the board, keeps the views that are worth it and calibrates with them on request.
/// docs/live.md describes topics, services and parameters.
class CoverageNode {
 public:
  CoverageNode(::ros::NodeHandle node, ::ros::NodeHandle private_node, const CoverageOptions& options);
  ~CoverageNode();

  /// Until the node is shut down. Callbacks are served by other threads.
  void run();

 private:
  using Clock = std::chrono::steady_clock;

  struct CameraState {
    CameraMonitor monitor;
    ::ros::Publisher overlay;
    std::size_t num_corners = 0;  ///< of the last image, and what became of it
    std::optional<double> blur_px;
    std::optional<guidance::Decision> decision;
  };

  std::vector<guidance::SeenImage> detect(const std::vector<ArrivedImage>& images);
  void process(const std::vector<ArrivedImage>& images);
  void updateSolve();
  void publishOverlay(const guidance::SeenImage& image, const guidance::Advice& advice, guidance::Decision decision);
  void publishDiagnostics();
  diagnostic_msgs::DiagnosticStatus status(int camera_index, double interval_s);
  bool onCalibrate(std_srvs::Trigger::Request& request, std_srvs::Trigger::Response& response);
  bool onReset(std_srvs::Trigger::Request& request, std_srvs::Trigger::Response& response);

  CoverageOptions options_;
  target::Target target_;
  detection::TargetDetector detector_;
  std::vector<CameraState> cameras_;
  Clock::time_point last_diagnostics_;
  bool is_waiting_ = true;  ///< nothing was processed since then

  std::mutex guide_mutex_;  ///< services run on other threads
  guidance::Guide guide_;
  std::future<std::optional<calibration::Rig>> solve_;

  ::ros::Publisher advice_;
  ::ros::Publisher diagnostics_;
  ::ros::Publisher progress_;
  ::ros::Publisher camchain_;
  CalibrationJob job_;
  std::vector<::ros::ServiceServer> services_;
  ImageInput input_;
};

}  // namespace tartan_calib::apps
