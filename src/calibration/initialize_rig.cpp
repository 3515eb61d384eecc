#include "tartan_calib/calibration/initialize_rig.h"

#include <cmath>
#include <limits>
#include <string>

#include "extrinsics.h"
#include "tartan_calib/calibration/camera_graph.h"
#include "tartan_calib/calibration/pose.h"
#include "tartan_calib/error.h"
#include "tartan_calib/solver/parallel.h"
#include "tartan_calib/text.h"

namespace tartan_calib::calibration {
namespace {

using geometry::Rigid3;
using observation::CameraView;
using observation::View;

ViewPoses posesOf(const std::vector<camera::Camera>& cameras, const std::vector<Eigen::Vector3d>& target_points,
                  const View& view) {
  ViewPoses poses;
  for (const CameraView& image : view.cameras) {
    const camera::Camera& camera = cameras.at(static_cast<std::size_t>(image.camera_index));
    if (const std::optional<Rigid3> T_cam_target = estimatePose(camera, target_points, image.corners)) {
      poses.push_back({image.camera_index, static_cast<int>(image.corners.size()), *T_cam_target});
    }
  }
  return poses;
}

/// Sum of Cauchy's loss over the corners of all cameras of a view.
double poseCost(const Rig& rig, const std::vector<Eigen::Vector3d>& target_points, const View& view,
                const Rigid3& T_rig_target) {
  constexpr double kScale_px = 5.0;  // extrinsics are not exact yet
  constexpr double kLost = 100.0;    // squared error of a corner without an image, in squared scales
  double cost = 0.0;
  for (const CameraView& image : view.cameras) {
    for (const observation::Corner& corner : image.corners) {
      const auto error_px = residual(rig, T_rig_target, target_points[static_cast<std::size_t>(corner.corner_id)],
                                     image.camera_index, corner.px);
      cost += std::log1p(error_px ? error_px->squaredNorm() / (kScale_px * kScale_px) : kLost);
    }
  }
  return cost;
}

/// Of the poses that single cameras know, the one that all cameras together like best.
Rigid3 bestRigPose(const Rig& rig, const std::vector<Eigen::Vector3d>& target_points, const View& view,
                   const ViewPoses& poses) {
  Rigid3 best;
  double best_cost = std::numeric_limits<double>::infinity();
  for (const CameraPose& pose : poses) {
    const Rigid3& T_cam_rig = rig.cameras[static_cast<std::size_t>(pose.camera_index)].T_cam_rig;
    const Rigid3 T_rig_target = T_cam_rig.inverse() * pose.T_cam_target;
    const double cost = poses.size() > 1 ? poseCost(rig, target_points, view, T_rig_target) : 0.0;
    if (cost < best_cost) {
      best_cost = cost;
      best = T_rig_target;
    }
  }
  return best;
}

}  // namespace

Problem initializeRig(const std::vector<camera::Camera>& cameras, const std::vector<Eigen::Vector3d>& target_points,
                      const std::vector<View>& views, const RigStartOptions& options) {
  const std::optional<Rig>& known_rig = options.known_rig;
  const int num_cameras = static_cast<int>(cameras.size());
  const auto known_pose = [&](std::size_t v) {
    return !options.known_rig || options.known_poses.empty() ? std::optional<Rigid3>() : options.known_poses.at(v);
  };
  std::vector<ViewPoses> poses(views.size());
  solver::forEachItem(static_cast<int>(views.size()), options.num_threads, [&](std::size_t v) {
    if (!known_pose(v)) {
      poses[v] = posesOf(cameras, target_points, views[v]);
    }
  });
  if (!known_rig) {
    requireConnected(sharedPoses(poses, num_cameras), "views in which both know where the board is",
                     "show the board to cameras of different groups at the same time, or raise --approx-sync");
  }
  const std::vector<Rigid3> T_cam_rig = known_rig ? std::vector<Rigid3>() : treeExtrinsics(poses, num_cameras);
  Problem problem;
  problem.target_points = target_points;
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    problem.rig.cameras.push_back({cameras[i], known_rig ? known_rig->cameras.at(i).T_cam_rig : T_cam_rig[i]});
  }
  for (std::size_t v = 0; v < views.size(); ++v) {
    if (const std::optional<Rigid3> known = known_pose(v); known || !poses[v].empty()) {
      problem.views.push_back(views[v]);
      problem.T_rig_target.push_back(known ? *known : bestRigPose(problem.rig, target_points, views[v], poses[v]));
    }
  }
  return problem;
}

}  // namespace tartan_calib::calibration
