#include "tartan_calib/report/pictures.h"

#include <gtest/gtest.h>

#include <memory>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "solved_scene.h"
#include "support/temporary_folder.h"

namespace tartan_calib::report {
namespace {

constexpr int kWidth = 1200;
constexpr int kHeight = 900;
constexpr std::size_t kUnreadable = 2;

test_support::Scene scene() {
  test_support::SceneOptions options;
  options.num_views = 8;
  return test_support::simulateScene(fisheye(kWidth, kHeight), options);
}

/// Dark images with a bright disc at the first corner of the view; one cannot be read.
pipeline::CameraStream streamOf(const test_support::Scene& scene) {
  std::vector<pipeline::StampedImage> images;
  for (std::size_t i = 0; i < scene.views.size(); ++i) {
    const Eigen::Vector2d px = scene.views[i].cameras.front().corners.front().px;
    images.push_back({scene.views[i].stamp_ns, [px, i] {
                        if (i == kUnreadable) {
                          throw InputError("broken");
                        }
                        cv::Mat image(kHeight, kWidth, CV_8UC1, cv::Scalar(10));
                        cv::circle(image, cv::Point(cvRound(px.x()), cvRound(px.y())), 8, cv::Scalar(250), cv::FILLED);
                        return image;
                      }});
  }
  pipeline::CameraStream stream{"/cam0/image_raw", images.size(), {}};
  stream.open = [images] {
    auto next = std::make_shared<std::size_t>(0);
    return [images, next]() -> std::optional<pipeline::StampedImage> {
      return *next < images.size() ? std::optional<pipeline::StampedImage>(images[(*next)++]) : std::nullopt;
    };
  };
  return stream;
}

class PicturesTest : public testing::Test {
 protected:
  CameraPictures take(const PictureOptions& options = {}) {
    const pipeline::CalibrationResult result = solved(waved);
    return takePictures({streamOf(waved)}, result, seenCorners(result), folder.path().string(), options).front();
  }

  /// Brightness of a picture where it shows a pixel of its image.
  double greyAt(const Picture& picture, const Eigen::Vector2d& px) const {
    const cv::Mat image = cv::imread(folder.file(picture.file), cv::IMREAD_GRAYSCALE);
    const Eigen::Vector2d place =
        (px - picture.origin_px.cast<double>() + Eigen::Vector2d(0.5, 0.5)) * picture.scale - Eigen::Vector2d(0.5, 0.5);
    return image.at<unsigned char>(cvRound(place.y()), cvRound(place.x()));
  }

  const Eigen::Vector2d& firstCorner(int view) const {
    return waved.views[static_cast<std::size_t>(view)].cameras.front().corners.front().px;
  }

  test_support::TemporaryFolder folder;
  test_support::Scene waved = scene();
};

TEST_F(PicturesTest, ShowEveryReadableViewAtTheSizeThatTheySay) {
  const CameraPictures pictures = take();
  EXPECT_EQ(pictures.frames.size(), waved.views.size() - 1);
  for (const Picture& frame : pictures.frames) {
    EXPECT_NE(frame.view, static_cast<int>(kUnreadable));
    EXPECT_LE(cv::imread(folder.file(frame.file)).cols, 480);
    EXPECT_GT(greyAt(frame, firstCorner(frame.view)), 150.0) << frame.view;
  }
}

TEST_F(PicturesTest, CutTheBoardOutOfTheWorstView) {
  std::vector<observation::Corner>& corners = waved.views[5].cameras.front().corners;
  for (std::size_t i = 1; i < corners.size(); i += 2) {
    corners[i].px.x() += 0.4;
  }
  PictureOptions options;
  options.num_worst = 1;
  const CameraPictures pictures = take(options);
  ASSERT_EQ(pictures.worst.size(), 1U);
  EXPECT_EQ(pictures.worst[0].view, 5);
  EXPECT_GT(greyAt(pictures.worst[0], firstCorner(5)), 150.0);
}

TEST_F(PicturesTest, AreBoundedInNumber) {
  PictureOptions options;
  options.max_frames = 3;
  options.num_worst = 0;
  EXPECT_LE(take(options).frames.size(), 3U);
}

TEST_F(PicturesTest, TellHowManyAreDone) {
  std::vector<std::size_t> dones;
  PictureOptions options;
  options.listener.progress = [&](std::size_t done, std::size_t total) {
    EXPECT_EQ(total, waved.views.size());
    dones.push_back(done);
  };
  take(options);
  ASSERT_EQ(dones.size(), waved.views.size());
  for (std::size_t i = 0; i < dones.size(); ++i) {
    EXPECT_EQ(dones[i], i + 1);
  }
}

TEST_F(PicturesTest, StopWhenCancelled) {
  std::size_t num_done = 0;
  PictureOptions options;
  options.num_threads = 1;
  options.listener.progress = [&](std::size_t done, std::size_t /*total*/) { num_done = done; };
  options.listener.is_cancelled = [&] { return num_done >= 3; };
  EXPECT_THROW(take(options), pipeline::Cancelled);
  EXPECT_EQ(num_done, 3U);
}

TEST_F(PicturesTest, KnowTheBrightestValueOfEveryPixel) {
  const CameraPictures pictures = take();
  double darkest = 0.0;
  double brightest = 0.0;
  cv::minMaxLoc(pictures.brightest, &darkest, &brightest);
  EXPECT_NEAR(darkest, 10.0, 1.0);
  EXPECT_GT(brightest, 240.0);
}

TEST_F(PicturesTest, AreTheSameWhateverTheThreads) {
  PictureOptions one;
  one.num_threads = 1;
  PictureOptions three;
  three.num_threads = 3;
  const CameraPictures first = take(one);
  const CameraPictures second = take(three);
  EXPECT_EQ(cv::norm(first.brightest, second.brightest, cv::NORM_INF), 0.0);
  EXPECT_EQ(first.frames.size(), second.frames.size());
}

}  // namespace
}  // namespace tartan_calib::report
