#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <memory>

#include "board_stream.h"
#include "support/expect_message.h"
#include "tartan_calib/pipeline/calibrate.h"

namespace tartan_calib::pipeline {
namespace {

using test_support::expectMessage;

CameraCorners detect(const std::vector<StampedImage>& images, int num_threads = 2, const Listener& listener = {}) {
  CalibrateOptions options;
  options.num_threads = num_threads;
  return detectCorners(streamOf(images), 0, smallGrid(), options, listener);
}

std::vector<std::int64_t> stamps(const CameraCorners& corners) {
  std::vector<std::int64_t> result;
  for (const observation::CameraView& image : corners.images) {
    result.push_back(image.stamp_ns);
  }
  return result;
}

TEST(DetectCorners, FindsTheBoardWhereItWasDrawn) {
  const Pinhole pinhole;
  const CameraCorners corners = detect(boardImages(3));
  ASSERT_EQ(corners.images.size(), 3U);
  EXPECT_EQ(corners.topic, "/cam0/image_raw");
  EXPECT_EQ(corners.width, 640);
  EXPECT_EQ(corners.height, 480);
  EXPECT_EQ(corners.counts.tags, 3 * 16);
  const std::vector<Eigen::Vector3d> points = target::cornerPoints(smallGrid());
  for (int i = 0; i < 3; ++i) {
    const observation::CameraView& image = corners.images[static_cast<std::size_t>(i)];
    EXPECT_GE(image.corners.size(), 60U);
    for (const observation::Corner& corner : image.corners) {
      const Eigen::Vector3d p_cam = boardPose(smallGrid(), i) * points[static_cast<std::size_t>(corner.corner_id)];
      const Eigen::Vector2d expected = pinhole.focal_px * p_cam.head<2>() / p_cam.z() + Eigen::Vector2d(319.5, 239.5);
      EXPECT_LT((corner.px - expected).norm(), 0.3);
    }
  }
}

TEST(DetectCorners, TheNumberOfThreadsChangesNothing) {
  const std::vector<StampedImage> images = boardImages(9);
  const CameraCorners one = detect(images, 1);
  for (const int num_threads : {2, 5}) {
    const CameraCorners many = detect(images, num_threads);
    ASSERT_EQ(stamps(many), stamps(one));
    for (std::size_t i = 0; i < one.images.size(); ++i) {
      ASSERT_EQ(many.images[i].corners.size(), one.images[i].corners.size());
      for (std::size_t k = 0; k < one.images[i].corners.size(); ++k) {
        EXPECT_EQ(many.images[i].corners[k].corner_id, one.images[i].corners[k].corner_id);
        EXPECT_EQ(many.images[i].corners[k].px, one.images[i].corners[k].px);
        EXPECT_EQ(many.images[i].corners[k].cov_px2, one.images[i].corners[k].cov_px2);
      }
    }
  }
}

TEST(DetectCorners, ImagesWithoutTheBoardAreCountedButAbsent) {
  std::vector<StampedImage> images = boardImages(3);
  images[1].load = [] { return cv::Mat(480, 640, CV_8UC1, cv::Scalar(90)); };
  const CameraCorners corners = detect(images);
  EXPECT_EQ(corners.num_images, 3U);
  EXPECT_EQ(stamps(corners), (std::vector<std::int64_t>{kPeriod_ns, 3 * kPeriod_ns}));
}

TEST(DetectCorners, OnlyAFewImagesPerThreadExistAtATime) {
  std::atomic<int> num_alive{0};
  std::atomic<int> max_alive{0};
  std::vector<StampedImage> images(60);
  for (std::size_t i = 0; i < images.size(); ++i) {
    images[i].stamp_ns = static_cast<std::int64_t>(i);
    images[i].load = [] { return cv::Mat(48, 64, CV_8UC1, cv::Scalar(0)); };
  }
  CameraStream stream = streamOf(images);
  const std::function<ImageSource()> open = stream.open;
  stream.open = [&, open] {  // counts the images that were handed out and still exist
    return [&, source = open()]() -> std::optional<StampedImage> {
      std::optional<StampedImage> image = source();
      if (image) {
        max_alive = std::max<int>(max_alive, ++num_alive);
        const std::shared_ptr<void> token(nullptr, [&](void*) { --num_alive; });
        image->load = [load = image->load, token] { return load(); };
      }
      return image;
    };
  };
  CalibrateOptions options;
  options.num_threads = 3;
  EXPECT_EQ(detectCorners(stream, 0, smallGrid(), options).num_images, 60U);
  EXPECT_EQ(num_alive, 0);
  EXPECT_LE(max_alive, 3 * 3);
}

TEST(DetectCorners, ImagesOfAnotherSizeThanMostAreSkippedAndCounted) {
  std::vector<StampedImage> images = boardImages(5);
  const std::vector<StampedImage> small = boardImages(2, {300.0, 480, 360});
  images[0].load = small[0].load;
  images[3].load = small[1].load;
  const CameraCorners corners = detect(images);
  EXPECT_EQ(corners.width, 640);
  EXPECT_EQ(corners.num_other_size, 2U);
  EXPECT_EQ(corners.counts.tags, 3 * 16);
  EXPECT_EQ(stamps(corners), (std::vector<std::int64_t>{2 * kPeriod_ns, 3 * kPeriod_ns, 5 * kPeriod_ns}));
}

TEST(DetectCorners, UnreadableImagesAreSkippedAndCountedWithTheFirstReason) {
  std::vector<StampedImage> images = boardImages(4);
  images[1].load = []() -> cv::Mat { throw InputError("truncated JPEG"); };
  images[2].load = []() -> cv::Mat { throw InputError("another reason"); };
  const CameraCorners corners = detect(images);
  EXPECT_EQ(corners.num_unreadable, 2U);
  EXPECT_EQ(corners.unreadable_reason, "truncated JPEG");
  EXPECT_EQ(stamps(corners), (std::vector<std::int64_t>{kPeriod_ns, 4 * kPeriod_ns}));
}

TEST(DetectCorners, ASecondImageOfTheSameStampIsSkippedAndCounted) {
  std::vector<StampedImage> images = boardImages(3);
  images[1].stamp_ns = images[0].stamp_ns;
  const CameraCorners corners = detect(images);
  EXPECT_EQ(corners.num_same_stamp, 1U);
  EXPECT_EQ(stamps(corners), (std::vector<std::int64_t>{kPeriod_ns, 3 * kPeriod_ns}));
}

TEST(DetectCorners, OtherFailuresOfLoadingEndTheRun) {
  std::vector<StampedImage> images = boardImages(4);
  images[2].load = []() -> cv::Mat { throw std::runtime_error("disk on fire"); };
  expectMessage<std::runtime_error>([&] { detect(images); }, {"disk on fire"});
}

TEST(DetectCorners, TellsItsProgressImageByImage) {
  std::vector<std::size_t> done;
  Listener listener;
  listener.progress = [&done](const Progress& progress) {
    EXPECT_EQ(progress.stage, Stage::kDetect);
    EXPECT_EQ(progress.camera_index, 0);
    EXPECT_EQ(progress.total, 4U);
    done.push_back(progress.done);
  };
  detect(boardImages(4), 3, listener);
  EXPECT_EQ(done, (std::vector<std::size_t>{0, 1, 2, 3, 4}));
}

TEST(DetectCorners, StopsWhenCancelled) {
  std::atomic<int> num_loaded{0};
  std::vector<StampedImage> images(1000);
  for (std::size_t i = 0; i < images.size(); ++i) {
    images[i].stamp_ns = static_cast<std::int64_t>(i);
    images[i].load = [&num_loaded] {
      ++num_loaded;
      return cv::Mat(48, 64, CV_8UC1, cv::Scalar(0));
    };
  }
  std::size_t done = 0;
  Listener listener;
  listener.progress = [&done](const Progress& progress) { done = progress.done; };
  listener.is_cancelled = [&done] { return done >= 5; };
  EXPECT_THROW(detect(images, 2, listener), Cancelled);
  EXPECT_LE(num_loaded, 5 + 2 * 2);
}

}  // namespace
}  // namespace tartan_calib::pipeline
