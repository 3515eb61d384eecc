#include "../../src/pipeline/rejected_corners.h"

#include <gtest/gtest.h>

namespace tartan_calib::pipeline {
namespace {

CameraCorners cornersOf(const std::map<std::int64_t, std::vector<int>>& ids_by_stamp) {
  CameraCorners corners;
  for (const auto& [stamp_ns, ids] : ids_by_stamp) {
    corners.images.push_back({0, stamp_ns, {}});
    for (const int id : ids) {
      observation::Corner corner;
      corner.corner_id = id;
      corners.images.back().corners.push_back(corner);
    }
  }
  return corners;
}

/// Ids by stamp, negative ones of corners that are not used.
std::map<std::int64_t, std::vector<int>> idsOf(const std::vector<observation::CameraView>& images) {
  std::map<std::int64_t, std::vector<int>> ids;
  for (const observation::CameraView& image : images) {
    for (const observation::Corner& corner : image.corners) {
      ids[image.stamp_ns].push_back(corner.used ? corner.corner_id : -corner.corner_id);
    }
  }
  return ids;
}

TEST(RejectedCorners, AreThoseThatNoLaterRoundFoundAgain) {
  RejectedCorners rejected;
  const CameraCorners first = cornersOf({{10, {1, 2, 3}}, {20, {4, 5}}, {30, {6}}});
  const CameraCorners second = cornersOf({{10, {1, 7}}});
  const CameraCorners third = cornersOf({{10, {1, 2, 7}}});
  rejected.update({first}, {second});
  rejected.update({second}, {third});

  CalibrationResult result;
  result.solution.counts.resize(1);
  result.solution.counts[0].outliers = 8;
  result.solution.views = {{10, third.images}};
  result.unused_images = cornersOf({{30, {9}}}).images;
  rejected.addTo(result);
  EXPECT_EQ(idsOf(result.solution.views[0].cameras), (std::map<std::int64_t, std::vector<int>>{{10, {1, 2, -3, 7}}}));
  EXPECT_EQ(idsOf(result.unused_images), (std::map<std::int64_t, std::vector<int>>{{20, {-4, -5}}, {30, {-6, 9}}}));
  EXPECT_EQ(result.solution.counts[0].outliers, 8 + 4);
}

}  // namespace
}  // namespace tartan_calib::pipeline
