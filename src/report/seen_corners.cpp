#include "tartan_calib/report/seen_corners.h"

#include <cmath>

namespace tartan_calib::report {
namespace {

double polarOf(const Eigen::Vector3d& ray) { return std::atan2(ray.head<2>().norm(), ray.z()); }

/// One image with everything that is known about it.
struct SolvedImage {
  int view = 0;
  const observation::CameraView& corners;
  const camera::Camera& camera;
  geometry::Rigid3 T_cam_target;
  const std::vector<Eigen::Vector3d>& target_points;
};

FoundCorner found(const SolvedImage& image, const observation::Corner& corner) {
  FoundCorner seen{image.view, corner.corner_id, corner.px, std::nullopt, std::nullopt, 0.0, corner.used, corner.round};
  const Eigen::Vector3d& p_target = image.target_points[static_cast<std::size_t>(corner.corner_id)];
  if (const auto predicted_px = camera::project(image.camera, image.T_cam_target * p_target)) {
    seen.residual_px = corner.px - *predicted_px;
  }
  if (const auto ray = camera::unproject(image.camera.model, corner.px)) {
    seen.polar_rad = polarOf(*ray);
    seen.azimuth_rad = std::atan2(ray->y(), ray->x());
  }
  return seen;
}

/// Appends the corners that are expected in the image and absent there. The board's z axis points to its viewer.
void addMissed(const SolvedImage& image, std::vector<MissedCorner>& missed) {
  if (image.T_cam_target.inverse().translation.z() <= 0.0) {
    return;
  }
  std::vector<bool> is_found(image.target_points.size(), false);
  for (const observation::Corner& corner : image.corners.corners) {
    is_found[static_cast<std::size_t>(corner.corner_id)] = true;
  }
  for (std::size_t id = 0; id < is_found.size(); ++id) {
    const Eigen::Vector3d p_cam = image.T_cam_target * image.target_points[id];
    const auto px = is_found[id] ? std::nullopt : camera::project(image.camera, p_cam);
    if (px && camera::isInside(image.camera, *px)) {
      missed.push_back({image.view, static_cast<int>(id), *px, polarOf(p_cam)});
    }
  }
}

}  // namespace

std::vector<SeenCorners> seenCorners(const pipeline::CalibrationResult& result) {
  const calibration::Solution& solution = result.solution;
  const std::vector<Eigen::Vector3d> points =
      calibration::warpedPoints(target::cornerPoints(result.target), solution.board_warp_m);
  std::vector<SeenCorners> cameras(solution.rig.cameras.size());
  for (std::size_t view = 0; view < solution.views.size(); ++view) {
    for (const observation::CameraView& corners : solution.views[view].cameras) {
      const auto at = static_cast<std::size_t>(corners.camera_index);
      const calibration::RigCamera& rig_camera = solution.rig.cameras[at];
      const SolvedImage image{static_cast<int>(view), corners, rig_camera.camera,
                              rig_camera.T_cam_rig * solution.T_rig_target[view], points};
      for (const observation::Corner& corner : corners.corners) {
        cameras[at].found.push_back(found(image, corner));
      }
      addMissed(image, cameras[at].missed);
    }
  }
  return cameras;
}

std::optional<double> polarAngle(const camera::CameraModel& model, const Eigen::Vector2d& px) {
  const auto ray = camera::unproject(model, px);
  return ray ? std::make_optional(polarOf(*ray)) : std::nullopt;
}

}  // namespace tartan_calib::report
