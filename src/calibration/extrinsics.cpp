#include "extrinsics.h"

#include <algorithm>
#include <cstddef>

#include "tartan_calib/geometry/averaging.h"

namespace tartan_calib::calibration {
namespace {

using geometry::Rigid3;

/// A view of a pair of cameras: T_a_b, from the smaller of the two numbers of corners.
struct RelativePose {
  int num_corners = 0;
  Rigid3 T_a_b;
};

const CameraPose* find(const ViewPoses& view, int camera_index) {
  const auto it = std::find_if(view.begin(), view.end(),
                               [camera_index](const CameraPose& pose) { return pose.camera_index == camera_index; });
  return it != view.end() ? &*it : nullptr;
}

std::vector<RelativePose> relativePoses(const std::vector<ViewPoses>& views, int camera_a, int camera_b) {
  std::vector<RelativePose> result;
  for (const ViewPoses& view : views) {
    const CameraPose* a = find(view, camera_a);
    const CameraPose* b = find(view, camera_b);
    if (a != nullptr && b != nullptr) {
      result.push_back({std::min(a->num_corners, b->num_corners), a->T_cam_target * b->T_cam_target.inverse()});
    }
  }
  return result;
}

/// Median over the views with most corners: poses from few corners are uncertain all in the same way.
Rigid3 medianRelativePose(std::vector<RelativePose> poses) {
  constexpr std::size_t kMaxViews = 100;
  std::stable_sort(poses.begin(), poses.end(),
                   [](const RelativePose& a, const RelativePose& b) { return a.num_corners > b.num_corners; });
  std::vector<Rigid3> best;
  for (const RelativePose& pose : poses) {
    if (best.size() < kMaxViews && 2 * pose.num_corners >= poses.front().num_corners) {
      best.push_back(pose.T_a_b);
    }
  }
  return geometry::medianRigid(best);
}

/// Corners that pairs of cameras share, all views together.
Eigen::MatrixXi sharedCorners(const std::vector<ViewPoses>& views, int num_cameras) {
  Eigen::MatrixXi corners = Eigen::MatrixXi::Zero(num_cameras, num_cameras);
  for (const ViewPoses& view : views) {
    for (const CameraPose& a : view) {
      for (const CameraPose& b : view) {
        corners(a.camera_index, b.camera_index) += std::min(a.num_corners, b.num_corners);
      }
    }
  }
  return corners;
}

struct Edge {
  int known = -1;
  int added = -1;
};

/// The pair with most corners between cameras that are in the tree and those that are not.
Edge strongestEdge(const Eigen::MatrixXi& shared_corners, const std::vector<bool>& is_in_tree) {
  Edge best;
  int most = -1;
  for (int known = 0; known < shared_corners.rows(); ++known) {
    for (int added = 0; added < shared_corners.cols(); ++added) {
      const bool is_candidate = is_in_tree[static_cast<std::size_t>(known)] && !is_in_tree[static_cast<std::size_t>(added)];
      if (is_candidate && shared_corners(known, added) > most) {
        most = shared_corners(known, added);
        best = {known, added};
      }
    }
  }
  return best;
}

}  // namespace

Eigen::MatrixXi sharedPoses(const std::vector<ViewPoses>& views, int num_cameras) {
  Eigen::MatrixXi shared = Eigen::MatrixXi::Zero(num_cameras, num_cameras);
  for (const ViewPoses& view : views) {
    for (const CameraPose& a : view) {
      for (const CameraPose& b : view) {
        shared(a.camera_index, b.camera_index) += 1;
      }
    }
  }
  return shared;
}

std::vector<Rigid3> treeExtrinsics(const std::vector<ViewPoses>& views, int num_cameras) {
  const Eigen::MatrixXi shared_corners = sharedCorners(views, num_cameras);
  std::vector<Rigid3> T_cam_rig(static_cast<std::size_t>(num_cameras));
  std::vector<bool> is_in_tree(static_cast<std::size_t>(num_cameras), false);
  is_in_tree[0] = true;
  for (int i = 1; i < num_cameras; ++i) {
    const Edge edge = strongestEdge(shared_corners, is_in_tree);
    const Rigid3 T_added_known = medianRelativePose(relativePoses(views, edge.added, edge.known));
    T_cam_rig[static_cast<std::size_t>(edge.added)] = T_added_known * T_cam_rig[static_cast<std::size_t>(edge.known)];
    is_in_tree[static_cast<std::size_t>(edge.added)] = true;
  }
  return T_cam_rig;
}

}  // namespace tartan_calib::calibration
