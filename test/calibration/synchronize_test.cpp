#include "tartan_calib/calibration/synchronize.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace tartan_calib::calibration {
namespace {

using observation::CameraView;
using observation::View;

constexpr std::int64_t kMillisecond_ns = 1'000'000;

std::vector<CameraView> images(int camera_index, const std::vector<std::int64_t>& stamps_ms) {
  std::vector<CameraView> result;
  for (const std::int64_t stamp_ms : stamps_ms) {
    CameraView image;
    image.camera_index = camera_index;
    image.stamp_ns = stamp_ms * kMillisecond_ns;
    result.push_back(image);
  }
  return result;
}

/// Per view the camera and stamp of each image.
std::vector<std::vector<std::pair<int, std::int64_t>>> content(const std::vector<View>& views) {
  std::vector<std::vector<std::pair<int, std::int64_t>>> result;
  for (const View& view : views) {
    result.emplace_back();
    for (const CameraView& image : view.cameras) {
      result.back().emplace_back(image.camera_index, image.stamp_ns / kMillisecond_ns);
    }
  }
  return result;
}

using Content = std::vector<std::vector<std::pair<int, std::int64_t>>>;

TEST(Synchronize, joins_the_nearest_stamps_and_not_the_first_within_tolerance) {
  const std::vector<View> views = synchronize({images(0, {0, 50}), images(1, {32, 82})}, 40 * kMillisecond_ns);
  EXPECT_EQ(content(views), (Content{{{0, 0}}, {{0, 50}, {1, 32}}, {{1, 82}}}));
}

TEST(Synchronize, takes_one_image_of_a_camera_per_view) {
  const std::vector<View> views = synchronize({images(0, {100}), images(1, {95, 102})}, 20 * kMillisecond_ns);
  EXPECT_EQ(content(views), (Content{{{1, 95}}, {{0, 100}, {1, 102}}}));
}

TEST(Synchronize, keeps_images_within_tolerance_of_the_first_camera) {
  const auto cameras = {images(0, {100}), images(1, {85}), images(2, {116})};
  EXPECT_EQ(content(synchronize(cameras, 16 * kMillisecond_ns)), (Content{{{0, 100}, {1, 85}, {2, 116}}}));
  EXPECT_EQ(content(synchronize(cameras, 15 * kMillisecond_ns)), (Content{{{0, 100}, {1, 85}}, {{2, 116}}}));
}

TEST(Synchronize, gives_a_view_the_stamp_of_its_first_camera_and_orders_views_by_it) {
  const std::vector<View> views = synchronize({images(0, {60}), images(1, {10, 55})}, 10 * kMillisecond_ns);
  ASSERT_EQ(views.size(), 2u);
  EXPECT_EQ(views[0].stamp_ns, 10 * kMillisecond_ns);
  EXPECT_EQ(views[1].stamp_ns, 60 * kMillisecond_ns);
}

/// Frames of `num_cameras` cameras at 20 Hz with jitter, every tenth image lost.
std::vector<std::vector<CameraView>> recording(int num_cameras, int num_frames) {
  std::mt19937 random(1);
  std::vector<std::vector<CameraView>> cameras;
  for (int camera = 0; camera < num_cameras; ++camera) {
    cameras.emplace_back();
    for (int frame = 0; frame < num_frames; ++frame) {
      if (random() % 10 != 0) {
        const auto jitter_ns = static_cast<std::int64_t>(random() % 8'000'000);
        cameras.back().push_back({camera, frame * 50 * kMillisecond_ns + jitter_ns, {}});
      }
    }
  }
  return cameras;
}

TEST(Synchronize, joins_thousands_of_jittered_frames_with_lost_images) {
  constexpr int kNumFrames = 5000;
  const std::vector<View> views = synchronize(recording(4, kNumFrames), 20 * kMillisecond_ns);
  // 4 cameras lose one frame together in 1 of 10^4 cases.
  EXPECT_GE(views.size(), 4990u);
  EXPECT_LE(views.size(), 5000u);
  for (const View& view : views) {
    for (const CameraView& image : view.cameras) {
      EXPECT_EQ(image.stamp_ns / (50 * kMillisecond_ns), view.stamp_ns / (50 * kMillisecond_ns));
    }
  }
}

TEST(Synchronize, does_not_depend_on_the_order_of_images_or_cameras) {
  auto cameras = recording(3, 100);
  const Content expected = content(synchronize(cameras, 20 * kMillisecond_ns));
  std::mt19937 random(2);
  for (auto& camera : cameras) {
    std::shuffle(camera.begin(), camera.end(), random);
  }
  std::reverse(cameras.begin(), cameras.end());
  EXPECT_EQ(content(synchronize(cameras, 20 * kMillisecond_ns)), expected);
}

TEST(Synchronize, makes_no_view_of_nothing) { EXPECT_TRUE(synchronize({{}, {}}, kMillisecond_ns).empty()); }

}  // namespace
}  // namespace tartan_calib::calibration
