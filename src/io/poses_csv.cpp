#include "tartan_calib/io/poses_csv.h"

#include <algorithm>

#include "number_text.h"

namespace tartan_calib::io {
namespace {

/// Of cam0's image where the view has one: the pose is that of cam0.
std::int64_t poseStamp(const observation::View& view) {
  const bool has_cam0 = !view.cameras.empty() && view.cameras.front().camera_index == 0;
  return has_cam0 ? view.cameras.front().stamp_ns : view.stamp_ns;
}

}  // namespace

std::string posesText(const pipeline::CalibrationResult& result) {
  constexpr int kDecimals = 6;  // as Kalibr
  std::string text = "#timestamp, p_RS_R_x [m], p_RS_R_y [m], p_RS_R_z [m], q_RS_w [], q_RS_x [], q_RS_y [], q_RS_z []\n";
  for (std::size_t i = 0; i < result.solution.views.size(); ++i) {
    const geometry::Rigid3 T_target_cam0 = result.solution.T_rig_target[i].inverse();
    const Eigen::Vector3d& t = T_target_cam0.translation;
    const Eigen::Quaterniond& q = T_target_cam0.rotation;
    text += std::to_string(poseStamp(result.solution.views[i]));
    for (const double value : {t.x(), t.y(), t.z(), q.w(), q.x(), q.y(), q.z()}) {
      text += "," + fixedText(value, kDecimals);
    }
    text += "\n";
  }
  return text;
}

}  // namespace tartan_calib::io
