#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <future>
#include <opencv2/imgproc.hpp>
#include <random>

#include "detection/detection_score.h"
#include "support/board_scene.h"
#include "tartan_calib/detection/target_detector.h"
#include "tartan_calib/error.h"

namespace tartan_calib::detection {
namespace {

using simulation::TrueCorner;
using test_support::BoardPose;
using test_support::BoardScene;
using test_support::kDegree;

const BoardPose kTilted = {1.1, 5.0 * kDegree, 1.0, 20.0 * kDegree, -25.0 * kDegree, 30.0 * kDegree};
const BoardPose kFacing = {1.0, 0.0, 0.0, 3.0 * kDegree, -5.0 * kDegree, 0.0};

camera::Camera vga() { return test_support::pinholeCamera(640, 480, 500.0); }

/// Tags of the 6 x 6 board that are in the picture with all their corners, `margin_px` away from its border.
int countVisibleTags(const std::vector<TrueCorner>& truth, const cv::Size& size, double margin_px) {
  const auto is_visible = [&](int id) {
    const auto corner = std::find_if(truth.begin(), truth.end(), [id](const TrueCorner& t) { return t.corner_id == id; });
    return corner != truth.end() && 0.5 + std::min({corner->px.x(), corner->px.y(), size.width - 1 - corner->px.x(),
                                                    size.height - 1 - corner->px.y()}) >=
                                        margin_px;
  };
  int count = 0;
  for (int tag = 0; tag < 36; ++tag) {
    const auto ids = target::tagCornerIds(target::AprilGrid{}, tag);
    count += std::all_of(ids.begin(), ids.end(), is_visible) ? 1 : 0;
  }
  return count;
}

TEST(AprilGridDetector, findsEveryCornerOfASharpBoard) {
  const target::AprilGrid grid;
  BoardScene scene(vga());
  const auto truth = scene.add(grid, kTilted);
  const Detection detection = TargetDetector(grid).detect(scene.expose(0.6, 2.0));
  const Score result = score(detection, truth);
  EXPECT_EQ(result.found, 144);
  EXPECT_EQ(result.wrong, 0);
  EXPECT_LT(result.median_error_px, 0.02);
  EXPECT_EQ(detection.counts.tags, 36);
  EXPECT_TRUE(std::is_sorted(detection.corners.begin(), detection.corners.end(),
                             [](const auto& a, const auto& b) { return a.corner_id < b.corner_id; }));
}

TEST(AprilGridDetector, knowsTheBoardInEveryTurn) {
  const target::AprilGrid grid;
  for (int turn = 0; turn < 12; ++turn) {
    BoardScene scene(vga());
    BoardPose pose = kTilted;
    pose.distance_m = 1.4;
    pose.roll_rad = turn * 30.0 * kDegree;
    const auto truth = scene.add(grid, pose);
    const Score result = score(TargetDetector(grid).detect(scene.expose(0.7, 2.0)), truth);
    EXPECT_GE(result.found, 142) << "roll " << turn * 30;
    EXPECT_EQ(result.wrong, 0) << "roll " << turn * 30;
  }
}

TEST(AprilGridDetector, statesAnUncertaintyThatFitsItsErrors) {
  const target::AprilGrid grid;
  for (const double noise_grey : {1.0, 4.0, 8.0}) {
    BoardScene scene(vga());
    const auto truth = scene.add(grid, kTilted);
    const Score result = score(TargetDetector(grid).detect(scene.expose(0.8, noise_grey)), truth);
    EXPECT_GT(result.rms_normalized_error, 0.4) << "noise " << noise_grey;
    EXPECT_LT(result.rms_normalized_error, 1.3) << "noise " << noise_grey;
  }
}

struct Difficulty {
  const char* name;
  double psf_sigma_px;
  double noise_grey;
  double max_median_error_px;
};

void PrintTo(const Difficulty& difficulty, std::ostream* os) { *os << difficulty.name; }

class AprilGridUnder : public testing::TestWithParam<Difficulty> {};

TEST_P(AprilGridUnder, isFoundAtFractionalPlaces) {
  const target::AprilGrid grid;
  int found = 0;
  for (int step = 0; step < 4; ++step) {
    BoardScene scene(vga());
    BoardPose pose = kTilted;
    pose.polar_rad += step * 0.25 / 500.0;  // a quarter of a pixel
    pose.azimuth_rad += step * 0.7;
    const auto truth = scene.add(grid, pose);
    const Score result =
        score(TargetDetector(grid).detect(scene.expose(GetParam().psf_sigma_px, GetParam().noise_grey)), truth);
    EXPECT_EQ(result.wrong, 0);
    EXPECT_LT(result.median_error_px, GetParam().max_median_error_px);
    found += result.found;
  }
  EXPECT_GE(found, 4 * 141);
}

INSTANTIATE_TEST_SUITE_P(Difficulties, AprilGridUnder,
                         testing::Values(Difficulty{"sharp", 0.4, 1.0, 0.015}, Difficulty{"soft", 1.0, 2.0, 0.02},
                                         Difficulty{"blurred", 1.6, 2.0, 0.03}, Difficulty{"noisy", 0.7, 8.0, 0.05}),
                         [](const auto& test) { return std::string(test.param.name); });

TEST(AprilGridDetector, knowsABoardThatIsTooBlurredToDecodeItsTags) {
  const target::AprilGrid grid;
  target::AprilGrid other = grid;
  other.code_offset = 100;
  BoardScene scene(vga());
  const auto truth = scene.add(grid, kTilted);
  const cv::Mat image = scene.expose(2.8, 2.0);
  const Score result = score(TargetDetector(grid).detect(image), truth);
  EXPECT_GE(result.found, 140);
  EXPECT_EQ(result.wrong, 0);
  EXPECT_TRUE(TargetDetector(other).detect(image).corners.empty());
}

TEST(AprilGridDetector, doesNotMindUnevenLight) {
  const target::AprilGrid grid;
  BoardScene scene(vga());
  const auto truth = scene.add(grid, kTilted);
  const Eigen::Vector2d centre(320.0, 240.0);
  for (int y = 0; y < scene.grey().rows; ++y) {
    for (int x = 0; x < scene.grey().cols; ++x) {
      const double radius = (Eigen::Vector2d(x, y) - centre).norm() / 400.0;
      scene.grey()(y, x) *= static_cast<float>(std::pow(std::cos(std::min(radius, 1.3)), 4.0) * (0.4 + 0.6 * x / 640.0));
    }
  }
  const Score result = score(TargetDetector(grid).detect(scene.expose(0.6, 1.0)), truth);
  EXPECT_GE(result.found, 143);
  EXPECT_EQ(result.wrong, 0);
  EXPECT_LT(result.median_error_px, 0.02);
}

TEST(AprilGridDetector, followsTheLensToTheRim) {
  const target::AprilGrid grid;
  const camera::Camera camera = test_support::fisheyeCamera(900, 900, 260.0);  // 90 degrees at 408 px
  for (const double polar_deg : {0.0, 45.0, 75.0}) {
    BoardScene scene(camera);
    const auto truth = scene.add(grid, {0.4, polar_deg * kDegree, 0.6, 10.0 * kDegree, -15.0 * kDegree, 0.4});
    const Detection detection = TargetDetector(grid).detect(scene.expose(0.6, 2.0));
    const Score result = score(detection, truth);
    const int visible_tags = countVisibleTags(truth, scene.grey().size(), 4.0);
    EXPECT_GE(detection.counts.tags, visible_tags) << polar_deg << " degrees";
    EXPECT_GE(result.found, 4 * visible_tags - 2) << polar_deg << " degrees";
    EXPECT_EQ(result.wrong, 0) << polar_deg << " degrees";
    EXPECT_LT(result.median_error_px, 0.02) << polar_deg << " degrees";
  }
}

TEST(AprilGridDetector, readsTagsOfTwelvePixels) {
  const target::AprilGrid grid;
  BoardScene scene(test_support::pinholeCamera(320, 240, 250.0));
  BoardPose pose = kFacing;
  pose.distance_m = grid.tag_size_m * 250.0 / 12.0;
  const auto truth = scene.add(grid, pose);
  const Score result = score(TargetDetector(grid).detect(scene.expose(0.5, 1.5)), truth);
  EXPECT_GE(result.found, 142);
  EXPECT_EQ(result.wrong, 0);
  EXPECT_LT(result.median_error_px, 0.06);
}

TEST(AprilGridDetector, reportsNothingUnderAHand) {
  const target::AprilGrid grid;
  BoardScene scene(vga());
  const auto truth = scene.add(grid, kTilted);
  const cv::RotatedRect hand({300.0F, 230.0F}, {170.0F, 110.0F}, 35.0F);
  cv::ellipse(scene.grey(), hand, cv::Scalar(140.0), cv::FILLED);
  cv::Mat1b covered(scene.grey().size(), uchar{0});
  cv::ellipse(covered, hand, cv::Scalar(255), cv::FILLED);
  const Detection detection = TargetDetector(grid).detect(scene.expose(0.6, 2.0));
  for (const observation::Corner& corner : detection.corners) {
    EXPECT_EQ(covered(static_cast<int>(std::lround(corner.px.y())), static_cast<int>(std::lround(corner.px.x()))), 0)
        << "corner " << corner.corner_id;
  }
  const Score result = score(detection, truth);
  EXPECT_EQ(result.wrong, 0);
  EXPECT_GE(result.found, 80);
}

TEST(AprilGridDetector, dropsTagsAtTheBorderOfTheImage) {
  const target::AprilGrid grid;
  BoardScene scene(vga());
  BoardPose pose = kTilted;
  pose.polar_rad = 22.0 * kDegree;
  const auto truth = scene.add(grid, pose);
  const cv::Mat image = scene.expose(0.6, 2.0);
  DetectorOptions options;
  for (const double distance_px : {4.0, 25.0}) {
    options.min_border_distance_px = distance_px;
    const Detection detection = TargetDetector(grid, options).detect(image);
    const Score result = score(detection, truth);
    EXPECT_EQ(result.wrong, 0);
    const int expected_tags = countVisibleTags(truth, image.size(), distance_px);
    ASSERT_GT(expected_tags, 5);
    ASSERT_LT(expected_tags, 36);
    EXPECT_EQ(detection.counts.tags, expected_tags);
  }
}

TEST(AprilGridDetector, findsBoardsOfEveryFamilyBorderAndOffset) {
  for (const char* family : {"t36h11", "t36h10", "t25h9", "t16h5"}) {
    for (const int border_cells : {1, 2}) {
      target::AprilGrid grid;
      grid.tag_rows = 4;
      grid.tag_cols = 5;
      grid.family = family;
      grid.border_cells = border_cells;
      grid.code_offset = 7;
      BoardScene scene(vga());
      const auto truth = scene.add(grid, kTilted);
      const Detection detection = TargetDetector(grid).detect(scene.expose(0.6, 2.0));
      const Score result = score(detection, truth);
      EXPECT_GE(result.found, 79) << family << " " << border_cells;
      EXPECT_EQ(result.wrong, 0) << family << " " << border_cells;
      EXPECT_EQ(detection.counts.foreign_tags, 0) << family << " " << border_cells;
    }
  }
}

/// Copies one tag of the picture over another.
void pasteTag(cv::Mat& image, const std::vector<TrueCorner>& truth, int from_tag, int to_tag) {
  const auto quad = [&truth](int tag) {
    std::vector<cv::Point2f> px;
    for (const int id : target::tagCornerIds(target::AprilGrid{}, tag)) {
      const auto& corner = truth.at(static_cast<std::size_t>(id));
      px.emplace_back(static_cast<float>(corner.px.x()), static_cast<float>(corner.px.y()));
    }
    return px;
  };
  cv::Mat warped;
  cv::warpPerspective(image, warped, cv::getPerspectiveTransform(quad(from_tag), quad(to_tag)), image.size());
  std::vector<cv::Point> outline;
  for (const cv::Point2f& px : quad(to_tag)) {
    outline.emplace_back(static_cast<int>(std::lround(px.x)), static_cast<int>(std::lround(px.y)));
  }
  cv::Mat1b mask(image.size(), uchar{0});
  cv::fillConvexPoly(mask, outline, cv::Scalar(255));
  warped.copyTo(image, mask);
}

TEST(AprilGridDetector, dropsATagThatContradictsItsNeighbours) {
  const target::AprilGrid grid;
  BoardScene scene(vga());
  const auto truth = scene.add(grid, kTilted);
  cv::Mat image = scene.expose(0.6, 2.0);
  constexpr int kWrongTag = 14;
  pasteTag(image, truth, 27, kWrongTag);
  const Detection detection = TargetDetector(grid).detect(image);
  EXPECT_EQ(score(detection, truth).wrong, 0);
  EXPECT_EQ(detection.counts.tags, 35);
  EXPECT_EQ(detection.counts.foreign_tags, 1);
  for (const int id : target::tagCornerIds(grid, kWrongTag)) {
    EXPECT_TRUE(
        std::none_of(detection.corners.begin(), detection.corners.end(), [id](const auto& c) { return c.corner_id == id; }));
  }
}

cv::Mat noise(int width, int height) {
  cv::Mat image(height, width, CV_8UC1);
  std::mt19937 random(5);
  for (auto pixel = image.begin<uchar>(); pixel != image.end<uchar>(); ++pixel) {
    *pixel = static_cast<uchar>(random() & 0xFFU);
  }
  return image;
}

TEST(AprilGridDetector, findsNothingWhereNothingIs) {
  const TargetDetector detector{target::AprilGrid{}};
  cv::Mat blobs;
  cv::GaussianBlur(noise(640, 480), blobs, {}, 2.0);
  cv::normalize(blobs, blobs, 0, 255, cv::NORM_MINMAX);
  BoardScene checkers(vga());
  checkers.add(target::Checkerboard{9, 8, 0.05, 0.05}, kFacing);
  for (const cv::Mat& image : {noise(640, 480), blobs, checkers.expose(0.6, 2.0), cv::Mat(cv::Mat::zeros(480, 640, CV_8UC1)),
                               cv::Mat(cv::Mat::zeros(1, 1, CV_8UC1)), cv::Mat(0, 0, CV_8UC1)}) {
    EXPECT_TRUE(detector.detect(image).corners.empty());
  }
}

TEST(AprilGridDetector, refusesABoardWithMoreTagsThanItsFamily) {
  target::AprilGrid grid;
  grid.family = "t16h5";
  EXPECT_THROW(TargetDetector{grid}, InputError);
}

TEST(AprilGridDetector, refusesOtherThanEightBits) {
  EXPECT_THROW(TargetDetector{target::AprilGrid{}}.detect(cv::Mat(100, 100, CV_16UC1)), InputError);
}

TEST(AprilGridDetector, givesTheSameInSeveralThreads) {
  const target::AprilGrid grid;
  BoardScene scene(vga());
  scene.add(grid, kTilted);
  const cv::Mat image = scene.expose(0.6, 2.0);
  const TargetDetector detector(grid);
  std::vector<std::future<Detection>> runs;
  for (int i = 0; i < 4; ++i) {
    runs.push_back(std::async(std::launch::async, [&] { return detector.detect(image); }));
  }
  const Detection expected = detector.detect(image);
  for (auto& run : runs) {
    const Detection detection = run.get();
    ASSERT_EQ(detection.corners.size(), expected.corners.size());
    for (std::size_t i = 0; i < expected.corners.size(); ++i) {
      EXPECT_EQ(detection.corners[i].px, expected.corners[i].px);
    }
  }
}

}  // namespace
}  // namespace tartan_calib::detection
