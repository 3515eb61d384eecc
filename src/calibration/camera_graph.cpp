#include "tartan_calib/calibration/camera_graph.h"

#include <algorithm>
#include <cstddef>

#include "tartan_calib/error.h"
#include "tartan_calib/text.h"

namespace tartan_calib::calibration {
namespace {

using observation::CameraView;
using observation::Corner;

/// Corners of the same id; both lists are ordered by id.
int numSharedCorners(const std::vector<Corner>& a, const std::vector<Corner>& b) {
  int count = 0;
  for (std::size_t i = 0, j = 0; i < a.size() && j < b.size();) {
    const int difference = a[i].corner_id - b[j].corner_id;
    count += difference == 0 ? 1 : 0;
    i += difference <= 0 ? 1 : 0;
    j += difference >= 0 ? 1 : 0;
  }
  return count;
}

void collectGroup(const Eigen::MatrixXi& shared_views, int camera_index, std::vector<bool>& is_reached,
                  std::vector<int>& group) {
  is_reached[static_cast<std::size_t>(camera_index)] = true;
  group.push_back(camera_index);
  for (int other = 0; other < shared_views.cols(); ++other) {
    if (!is_reached[static_cast<std::size_t>(other)] && shared_views(camera_index, other) > 0) {
      collectGroup(shared_views, other, is_reached, group);
    }
  }
}

std::string groupNames(const std::vector<std::vector<int>>& groups) {
  std::string text;
  for (const std::vector<int>& group : groups) {
    std::string members;
    for (const int camera_index : group) {
      members += (members.empty() ? "" : " ") + cameraName(camera_index);
    }
    text += (text.empty() ? "{" : ", {") + members + "}";
  }
  return text;
}

std::string pairCounts(const Eigen::MatrixXi& shared_views) {
  std::string text;
  for (int a = 0; a < shared_views.rows(); ++a) {
    for (int b = a + 1; b < shared_views.cols(); ++b) {
      text += (text.empty() ? "" : ", ") + cameraName(a) + "-" + cameraName(b) + " " + std::to_string(shared_views(a, b));
    }
  }
  return text;
}

}  // namespace

CameraGraph cameraGraph(const std::vector<observation::View>& views, int num_cameras) {
  CameraGraph graph;
  graph.shared_views = Eigen::MatrixXi::Zero(num_cameras, num_cameras);
  graph.shared_corners = Eigen::MatrixXi::Zero(num_cameras, num_cameras);
  for (const observation::View& view : views) {
    for (const CameraView& a : view.cameras) {
      for (const CameraView& b : view.cameras) {
        if (!a.corners.empty() && !b.corners.empty()) {
          graph.shared_views(a.camera_index, b.camera_index) += 1;
          graph.shared_corners(a.camera_index, b.camera_index) += numSharedCorners(a.corners, b.corners);
        }
      }
    }
  }
  graph.groups = connectedGroups(graph.shared_views);
  return graph;
}

std::vector<std::vector<int>> connectedGroups(const Eigen::MatrixXi& shared_views) {
  std::vector<std::vector<int>> groups;
  std::vector<bool> is_reached(static_cast<std::size_t>(shared_views.cols()), false);
  for (int i = 0; i < shared_views.cols(); ++i) {
    if (!is_reached[static_cast<std::size_t>(i)]) {
      groups.emplace_back();
      collectGroup(shared_views, i, is_reached, groups.back());
      std::sort(groups.back().begin(), groups.back().end());
    }
  }
  return groups;
}

void requireConnected(const Eigen::MatrixXi& shared_views, const std::string& shared, const std::string& remedy) {
  const std::vector<std::vector<int>> groups = connectedGroups(shared_views);
  if (groups.size() > 1) {
    throw CalibrationError("Cameras are not connected through mutual observations: groups " + groupNames(groups) + "; " +
                           shared + ": " + pairCounts(shared_views) + "; " + remedy);
  }
}

}  // namespace tartan_calib::calibration
