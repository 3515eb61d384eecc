#include "detect_corners/detect_corners.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <opencv2/imgcodecs.hpp>

#include "common/program.h"
#include "detect_corners/corner_pictures.h"
#include "support/temporary_folder.h"
#include "tartan_calib/error.h"

namespace tartan_calib::apps {
namespace {

using Indices = std::vector<std::size_t>;

observation::CameraView viewWith(std::size_t num_corners, std::int64_t stamp_ns) {
  observation::CameraView view;
  view.stamp_ns = stamp_ns;
  view.corners.resize(num_corners);
  return view;
}

/// Ten blank images; the fourth cannot be read.
pipeline::CameraStream blankStream() {
  pipeline::CameraStream stream{"/cam0/image_raw", 10, {}};
  stream.open = [] {
    auto index = std::make_shared<std::int64_t>(0);
    return [index]() -> std::optional<pipeline::StampedImage> {
      if (*index == 10) {
        return std::nullopt;
      }
      const std::int64_t stamp_ns = 100 + (*index)++;
      return pipeline::StampedImage{stamp_ns, [stamp_ns]() -> cv::Mat {
                                      if (stamp_ns == 103) {
                                        throw InputError("broken");
                                      }
                                      return cv::Mat(40, 60, CV_8UC1, cv::Scalar(90));
                                    }};
    };
  };
  return stream;
}

TEST(DetectOptions, TheOutputIsBesideTheRecordingUnlessItIsNamed) {
  const std::vector<std::string> words = {"--bag", "a/rig.bag", "--target", "t.yaml", "--topics", "/a", "/b"};
  EXPECT_EQ(parseDetectOptions(words)->output, "a/rig-corners.csv");
  EXPECT_EQ(parseDetectOptions(words)->topics, (std::vector<std::string>{"/a", "/b"}));
  std::vector<std::string> named = words;
  named.insert(named.end(), {"--output", "x.csv", "--bag-from-to", "1", "2"});
  EXPECT_EQ(parseDetectOptions(named)->output, "x.csv");
  EXPECT_EQ(parseDetectOptions(named)->selection.window->to_s, 2.0);
  EXPECT_FALSE(parseDetectOptions({"--help"}).has_value());
}

TEST(DetectOptions, WhatCannotBeIsRefused) {
  const std::vector<std::string> words = {"--bag", "rig.bag", "--target", "t.yaml", "--topics", "/a"};
  EXPECT_THROW(parseDetectOptions({"--bag", "rig.bag"}), UsageError);
  for (const auto& [flag, value] : {std::make_pair("--max-pictures", "0"), std::make_pair("--threads", "-1"),
                                    std::make_pair("--min-border-distance", "-3")}) {
    std::vector<std::string> wrong = words;
    wrong.insert(wrong.end(), {std::string(flag) + "=" + value});
    EXPECT_THROW(parseDetectOptions(wrong), UsageError) << flag;
  }
}

TEST(EvenlyChosen, CoversAllImagesFromTheFirst) {
  EXPECT_EQ(evenlyChosen(10, 3), (Indices{0, 3, 6}));
  EXPECT_EQ(evenlyChosen(3, 10), (Indices{0, 1, 2}));
  EXPECT_EQ(evenlyChosen(0, 10), Indices{});
}

TEST(DrawCorners, RingsAreAroundCornersAndNowhereElse) {
  const cv::Mat gray(60, 80, CV_8UC1, cv::Scalar(90));
  const observation::Corner corner{0, {40.0, 30.0}};
  const cv::Mat picture = drawCorners(gray, {corner}, target::AprilGrid{});
  ASSERT_EQ(picture.type(), CV_8UC3);
  EXPECT_EQ(picture.at<cv::Vec3b>(30, 40), cv::Vec3b(90, 90, 90));  // the corner itself stays in sight
  EXPECT_NE(picture.at<cv::Vec3b>(30, 45), cv::Vec3b(90, 90, 90));
  EXPECT_EQ(picture.at<cv::Vec3b>(30, 55), cv::Vec3b(90, 90, 90));
}

TEST(CornerPictures, AreNamedByStampAndLeaveOutWhatCannotBeRead) {
  const test_support::TemporaryFolder folder;
  std::vector<std::size_t> progress;
  const auto note = [&](std::size_t done, std::size_t /*total*/) { progress.push_back(done); };
  const std::string all = folder.file("all");
  EXPECT_EQ(writeCornerPictures(blankStream(), {viewWith(1, 102)}, target::AprilGrid{}, all, 20, note), 9U);
  EXPECT_EQ(progress.back(), 10U);
  EXPECT_FALSE(std::filesystem::exists(all + "/103.png"));
  EXPECT_EQ(cv::imread(all + "/109.png").size(), cv::Size(60, 40));
  const std::string some = folder.file("some");
  EXPECT_EQ(writeCornerPictures(blankStream(), {}, target::AprilGrid{}, some, 2, note), 2U);
  EXPECT_TRUE(std::filesystem::exists(some + "/105.png"));
}

TEST(DetectionText, CountsImagesCornersAndDroppedTags) {
  pipeline::CameraCorners corners;
  corners.topic = "/cam0/image_raw";
  corners.width = 640;
  corners.height = 480;
  corners.num_images = 4;
  corners.images = {viewWith(10, 1), viewWith(20, 2), viewWith(60, 3)};
  corners.counts.tags = 20;
  corners.counts.duplicate_tags = 3;
  corners.counts.mirrored_tags = 2;
  const std::string text = detectionText(corners, 0, target::AprilGrid{});
  for (const char* part :
       {"cam0 (/cam0/image_raw): 640x480", "4, 3 with board (75.0 %)",
        "90, 30.0 in an image with board (least 10, median 20, most 60), of 144", "20; dropped: 3 seen", "2 mirrored"}) {
    EXPECT_NE(text.find(part), std::string::npos) << part << " is not in\n" << text;
  }
  const std::string board = detectionText({}, 1, target::Checkerboard{5, 6, 0.1, 0.1});
  EXPECT_EQ(board.find("tags"), std::string::npos);
  EXPECT_NE(board.find("none"), std::string::npos);
}

}  // namespace
}  // namespace tartan_calib::apps
