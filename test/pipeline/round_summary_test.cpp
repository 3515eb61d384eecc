#include "../../src/pipeline/round_summary.h"

#include <gtest/gtest.h>

namespace tartan_calib::pipeline {
namespace {

/// One camera that saw corners with these ids in one image.
CameraCorners seen(std::int64_t stamp_ns, const std::vector<int>& ids) {
  CameraCorners camera;
  camera.images = {{0, stamp_ns, {}}};
  for (const int id : ids) {
    observation::Corner corner;
    corner.corner_id = id;
    corner.used = false;
    camera.images[0].corners.push_back(corner);
  }
  return camera;
}

TEST(RoundSummary, CountsCornersByCameraImageAndId) {
  const RoundSummary same = compareCorners({seen(1, {0, 1, 2})}, {seen(1, {0, 1, 2})});
  EXPECT_EQ(same.gained, 0);
  EXPECT_EQ(same.lost, 0);
  const RoundSummary changed = compareCorners({seen(1, {0, 1, 2})}, {seen(1, {1, 2, 3, 4})});
  EXPECT_EQ(changed.gained, 2);
  EXPECT_EQ(changed.lost, 1);
  const RoundSummary other_image = compareCorners({seen(1, {0, 1, 2})}, {seen(2, {0, 1})});
  EXPECT_EQ(other_image.gained, 2);
  EXPECT_EQ(other_image.lost, 3);
  const RoundSummary other_camera = compareCorners({seen(1, {0}), seen(1, {})}, {seen(1, {}), seen(1, {0})});
  EXPECT_EQ(other_camera.gained, 1);
  EXPECT_EQ(other_camera.lost, 1);
}

TEST(RoundSummary, IsSettledWhereNeitherCornersNorModelChange) {
  RoundSummary summary;
  summary.corners = 1000;
  summary.gained = 9;
  summary.model_change_px = 0.019;
  EXPECT_TRUE(isSettled(summary));
  summary.gained = 10;
  EXPECT_FALSE(isSettled(summary));
  summary.gained = 9;
  summary.model_change_px = 0.021;
  EXPECT_FALSE(isSettled(summary));
}

TEST(RoundSummary, OnlyImagesWithCornersEnoughForAPoseTakePartAllOfThemInPlay) {
  CameraCorners camera = seen(1, {0, 1, 2});
  camera.images.push_back(seen(2, {0, 1, 2, 3}).images[0]);
  const std::vector<observation::CameraView> images = imagesWithCorners(camera);
  ASSERT_EQ(images.size(), 1U);
  EXPECT_EQ(images[0].stamp_ns, 2);
  for (const observation::Corner& corner : images[0].corners) {
    EXPECT_TRUE(corner.used);
  }
}

}  // namespace
}  // namespace tartan_calib::pipeline
