#include "live/camera_monitor.h"

#include <ros/this_node.h>

#include "live/messages.h"
#include "tartan_calib/text.h"

namespace tartan_calib::apps {

using diagnostic_msgs::DiagnosticStatus;

void CameraMonitor::countUnreadable(const std::string& reason) {
  ++now_.unreadable;
  unreadable_reason_ = reason;
}

DiagnosticStatus CameraMonitor::status(const InputCounts& counts, double interval_s) {
  now_.received = counts.received;
  DiagnosticStatus status;
  status.name = ::ros::this_node::getName() + ": " + cameraName(camera_index_);
  status.hardware_id = topic_;
  if (now_.received == before_.received) {
    worsen(status, DiagnosticStatus::STALE, "no images on " + topic_);
  }
  if (now_.unreadable > before_.unreadable) {
    worsen(status, DiagnosticStatus::ERROR, "broken image: " + unreadable_reason_);
  }
  addValue(status, "processed rate [Hz]",
           format("%.1f", static_cast<double>(now_.processed - before_.processed) / interval_s));
  addValue(status, "received", std::to_string(counts.received));
  addValue(status, "dropped", std::to_string(counts.dropped));
  addValue(status, "unreadable", std::to_string(now_.unreadable));
  before_ = now_;
  return status;
}

}  // namespace tartan_calib::apps
