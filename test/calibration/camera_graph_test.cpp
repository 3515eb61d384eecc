#include "tartan_calib/calibration/camera_graph.h"

#include <gtest/gtest.h>

namespace tartan_calib::calibration {
namespace {

using observation::CameraView;
using observation::View;

CameraView seen(int camera_index, const std::vector<int>& corner_ids) {
  CameraView image;
  image.camera_index = camera_index;
  for (const int id : corner_ids) {
    image.corners.push_back({id, {0.0, 0.0}});
  }
  return image;
}

View view(const std::vector<CameraView>& images) {
  View result;
  result.cameras = images;
  return result;
}

TEST(CameraGraph, counts_shared_views_and_corners) {
  const std::vector<View> views = {view({seen(0, {1, 2, 3}), seen(1, {2, 3, 4}), seen(2, {7})}),
                                   view({seen(0, {1, 5}), seen(1, {1})}), view({seen(1, {6})})};
  const CameraGraph graph = cameraGraph(views, 3);
  Eigen::Matrix3i shared_views;
  shared_views << 2, 2, 1, 2, 3, 1, 1, 1, 1;
  Eigen::Matrix3i shared_corners;
  shared_corners << 5, 3, 0, 3, 5, 0, 0, 0, 1;
  EXPECT_EQ(graph.shared_views, shared_views);
  EXPECT_EQ(graph.shared_corners, shared_corners);
  EXPECT_EQ(graph.groups, (std::vector<std::vector<int>>{{0, 1, 2}}));
}

TEST(CameraGraph, names_groups_that_share_no_view) {
  const std::vector<View> views = {view({seen(0, {1}), seen(3, {1})}), view({seen(1, {1}), seen(4, {1})}),
                                   view({seen(3, {2}), seen(5, {2})}), view({seen(2, {})})};
  EXPECT_EQ(cameraGraph(views, 6).groups, (std::vector<std::vector<int>>{{0, 3, 5}, {1, 4}, {2}}));
}

}  // namespace
}  // namespace tartan_calib::calibration
