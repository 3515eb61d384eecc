#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <random>

#include "support/board_scene.h"
#include "support/test_data.h"
#include "tartan_calib/detection/target_detector.h"

namespace tartan_calib::detection {
namespace {

using simulation::TrueCorner;
using test_support::BoardPose;
using test_support::BoardScene;
using test_support::kDegree;

// Rows and columns are told apart by their number, the ends of a row by the colour beyond corner 0.
const target::Checkerboard kBoard{6, 9, 0.03, 0.03};

struct Score {
  int found = 0;
  double rms_px = 0.0;
  double max_px = 0.0;
};

/// Distances from the corners of the same id as drawn.
Score score(const Detection& detection, const std::vector<TrueCorner>& truth) {
  std::map<int, Eigen::Vector2d> true_px;
  for (const TrueCorner& corner : truth) {
    true_px[corner.corner_id] = corner.px;
  }
  Score score;
  double sum_px2 = 0.0;
  for (const observation::Corner& corner : detection.corners) {
    const double error_px = (true_px.at(corner.corner_id) - corner.px).norm();
    sum_px2 += error_px * error_px;
    score.max_px = std::max(score.max_px, error_px);
    ++score.found;
  }
  score.rms_px = std::sqrt(sum_px2 / std::max(1, score.found));
  return score;
}

void expectWholeBoard(const Detection& detection, const std::vector<TrueCorner>& truth, double max_rms_px) {
  const Score result = score(detection, truth);
  EXPECT_EQ(result.found, static_cast<int>(truth.size()));
  EXPECT_LT(result.rms_px, max_rms_px);
  EXPECT_LT(result.max_px, 5.0 * max_rms_px);
  EXPECT_EQ(detection.counts.tags, 1);
}

Detection detect(const target::Checkerboard& board, const cv::Mat& image) { return TargetDetector(board).detect(image); }

class CheckerboardTurned : public testing::TestWithParam<int> {};

TEST_P(CheckerboardTurned, keepsItsNumbersHoweverItIsTurned) {
  BoardScene scene(test_support::pinholeCamera(640, 480, 500.0));
  const auto truth = scene.add(kBoard, {0.6, 5.0 * kDegree, 1.0, 20.0 * kDegree, -25.0 * kDegree, GetParam() * kDegree});
  expectWholeBoard(detect(kBoard, scene.expose(0.6, 2.0)), truth, 0.02);
}

INSTANTIATE_TEST_SUITE_P(, CheckerboardTurned, testing::Values(0, 45, 90, 135, 180, 225, 270, 315));

TEST(Checkerboard, isFoundWithRectanglesForSquares) {
  const target::Checkerboard board{7, 4, 0.02, 0.05};
  BoardScene scene(test_support::pinholeCamera(640, 480, 500.0));
  const auto truth = scene.add(board, {0.6, 0.0, 0.0, 20.0 * kDegree, 10.0 * kDegree, 30.0 * kDegree});
  expectWholeBoard(detect(board, scene.expose(0.6, 2.0)), truth, 0.02);
}

TEST(Checkerboard, isFoundWhereAFisheyeBendsIt) {
  for (const double polar_deg : {0.0, 40.0, 60.0}) {
    BoardScene scene(test_support::fisheyeCamera(1100, 1100, 280.0));
    const auto truth = scene.add(kBoard, {0.12, polar_deg * kDegree, 0.7, 15.0 * kDegree, 0.0, 40.0 * kDegree});
    SCOPED_TRACE(polar_deg);
    expectWholeBoard(detect(kBoard, scene.expose(0.7, 2.0)), truth, 0.02);
  }
}

TEST(Checkerboard, isFoundThroughBlurAndNoise) {
  BoardScene scene(test_support::pinholeCamera(640, 480, 500.0));
  const auto truth = scene.add(kBoard, {0.6, 0.0, 0.0, 30.0 * kDegree, 10.0 * kDegree, 30.0 * kDegree});
  expectWholeBoard(detect(kBoard, scene.expose(2.0, 2.0)), truth, 0.05);
  expectWholeBoard(detect(kBoard, scene.expose(3.0, 2.0)), truth, 0.10);
  expectWholeBoard(detect(kBoard, scene.expose(0.7, 10.0)), truth, 0.06);
}

TEST(Checkerboard, isFoundWithSquaresOfEightPixels) {
  BoardScene scene(test_support::pinholeCamera(640, 480, 500.0));
  const auto truth = scene.add(kBoard, {1.9, 8.0 * kDegree, 2.0, 0.0, 10.0 * kDegree, 30.0 * kDegree});
  expectWholeBoard(detect(kBoard, scene.expose(0.6, 2.0)), truth, 0.06);
}

TEST(Checkerboard, isNotReportedInPart) {
  BoardScene scene(test_support::pinholeCamera(640, 480, 500.0));
  // The last rows are beyond the image's border.
  scene.add(kBoard, {0.5, 28.0 * kDegree, 0.0, 0.0, 0.0, 0.0});
  EXPECT_TRUE(detect(kBoard, scene.expose(0.6, 2.0)).corners.empty());
}

TEST(Checkerboard, isReportedWithoutHiddenCorners) {
  BoardScene scene(test_support::pinholeCamera(640, 480, 500.0));
  const auto truth = scene.add(kBoard, {0.55, 0.0, 0.0, 20.0 * kDegree, 10.0 * kDegree, 10.0 * kDegree});
  const std::vector<int> hidden{13, 14, 31, 40, 53};
  for (const int id : hidden) {
    const Eigen::Vector2d& px = truth[static_cast<std::size_t>(id)].px;
    cv::circle(scene.grey(), cv::Point2d(px.x(), px.y()), 9, cv::Scalar(230.0), cv::FILLED);
  }
  const Detection detection = detect(kBoard, scene.expose(0.6, 2.0));
  const Score result = score(detection, truth);
  EXPECT_EQ(result.found, kBoard.rows * kBoard.cols - static_cast<int>(hidden.size()));
  EXPECT_LT(result.rms_px, 0.02);
  for (const observation::Corner& corner : detection.corners) {
    EXPECT_EQ(std::count(hidden.begin(), hidden.end(), corner.corner_id), 0) << corner.corner_id;
  }
}

TEST(Checkerboard, isNotReportedWhereTwoAreSeen) {
  BoardScene scene(test_support::pinholeCamera(640, 480, 500.0));
  scene.add(kBoard, {1.0, 15.0 * kDegree, 0.0, 0.0, 0.0, 0.0});
  scene.add(kBoard, {1.0, 15.0 * kDegree, 180.0 * kDegree, 0.0, 0.0, 0.0});
  const Detection detection = detect(kBoard, scene.expose(0.6, 2.0));
  EXPECT_TRUE(detection.corners.empty());
  EXPECT_EQ(detection.counts.duplicate_tags, 2);
}

TEST(Checkerboard, isFoundBesideOneOfAnotherSize) {
  BoardScene scene(test_support::pinholeCamera(640, 480, 500.0));
  const auto truth = scene.add(kBoard, {1.0, 15.0 * kDegree, 0.0, 0.0, 10.0 * kDegree, 20.0 * kDegree});
  scene.add(target::Checkerboard{10, 9, 0.03, 0.03}, {1.0, 17.0 * kDegree, 180.0 * kDegree, 0.0, 0.0, 0.0});
  expectWholeBoard(detect(kBoard, scene.expose(0.6, 2.0)), truth, 0.02);
}

TEST(Checkerboard, isNamedWithItsSizeWhereTheTargetHasAnother) {
  BoardScene scene(test_support::pinholeCamera(640, 480, 500.0));
  scene.add(target::Checkerboard{10, 7, 0.03, 0.03}, {1.0, 5.0 * kDegree, 0.0, 0.0, 10.0 * kDegree, 20.0 * kDegree});
  const Detection detection = detect(kBoard, scene.expose(0.6, 2.0));
  EXPECT_TRUE(detection.corners.empty());
  EXPECT_EQ(detection.counts.other_sizes, (std::map<BoardSize, int>{{{7, 10}, 1}}));
}

TEST(Checkerboard, isFoundWhereAStrangeSquareContinuesIt) {
  BoardScene scene(test_support::pinholeCamera(640, 480, 500.0));
  const auto truth = scene.add(kBoard, {0.6, 0.0, 0.0, 0.0, 0.0, 0.0});
  const auto at = [&truth](double row, double col) {
    const Eigen::Vector2d row_step = truth[static_cast<std::size_t>(kBoard.cols)].px - truth[0].px;
    const Eigen::Vector2d px = truth[0].px + row * row_step + col * (truth[1].px - truth[0].px);
    return cv::Point(static_cast<int>(std::lround(px.x())), static_cast<int>(std::lround(px.y())));
  };
  // Two more crossings in line with the columns, beyond the board's last squares.
  const std::vector<cv::Point> square{at(-2, 4), at(-2, 5), at(-1, 5), at(-1, 4)};
  cv::fillConvexPoly(scene.grey(), square, cv::Scalar(BoardScene::kBlackGrey));
  expectWholeBoard(detect(kBoard, scene.expose(0.6, 2.0)), truth, 0.02);
}

TEST(Checkerboard, isFoundInClutter) {
  std::mt19937 random(3);
  BoardScene scene(test_support::pinholeCamera(640, 480, 500.0));
  for (int k = 0; k < 400; ++k) {
    const auto up_to = [&random](int limit) { return static_cast<int>(random() % static_cast<unsigned>(limit)); };
    cv::rectangle(scene.grey(), cv::Rect(up_to(620), up_to(460), 5 + up_to(40), 5 + up_to(40)), cv::Scalar(up_to(256)),
                  cv::FILLED);
  }
  EXPECT_TRUE(detect(kBoard, scene.expose(0.6, 2.0)).corners.empty());
  const auto truth = scene.add(kBoard, {0.8, 5.0 * kDegree, 1.0, 20.0 * kDegree, 10.0 * kDegree, 200.0 * kDegree});
  expectWholeBoard(detect(kBoard, scene.expose(0.6, 2.0)), truth, 0.02);
}

TEST(Checkerboard, isNotFoundInNoise) {
  BoardScene scene(test_support::pinholeCamera(640, 480, 500.0));
  EXPECT_TRUE(detect(kBoard, scene.expose(0.6, 20.0)).corners.empty());
  EXPECT_TRUE(detect(kBoard, cv::Mat(480, 640, CV_8UC1, cv::Scalar(0))).corners.empty());
  EXPECT_TRUE(detect(kBoard, cv::Mat(3, 3, CV_8UC1, cv::Scalar(0))).corners.empty());
}

TEST(Checkerboard, losesCornersAtTheImagesBorder) {
  BoardScene scene(test_support::pinholeCamera(640, 480, 500.0));
  const auto truth = scene.add(kBoard, {0.8, 0.0, 0.0, 0.0, 0.0, 0.0});
  DetectorOptions options;
  const double nearest_px =
      std::min_element(truth.begin(), truth.end(), [](const auto& a, const auto& b) { return a.px.y() < b.px.y(); })->px.y();
  const auto count_at = [&](double distance_px) {
    options.min_border_distance_px = distance_px;
    return TargetDetector(kBoard, options).detect(scene.expose(0.6, 2.0)).corners.size();
  };
  EXPECT_EQ(count_at(nearest_px - 1.0), truth.size());
  EXPECT_LT(count_at(nearest_px + 1.0), truth.size());
}

/// The corner ids of a board that is turned by quarters, in the order of the ids as drawn.
std::vector<int> turnedIds(const target::Checkerboard& board, int quarter_turns) {
  std::vector<int> ids;
  for (int row = 0; row < board.rows; ++row) {
    for (int col = 0; col < board.cols; ++col) {
      const std::array<int, 4> turned{row * board.cols + col, (board.cols - 1 - col) * board.rows + row,
                                      (board.rows - 1 - row) * board.cols + board.cols - 1 - col,
                                      col * board.rows + board.rows - 1 - row};
      ids.push_back(turned[static_cast<std::size_t>(quarter_turns)]);
    }
  }
  return ids;
}

class SymmetricCheckerboard : public testing::TestWithParam<target::Checkerboard> {};

TEST_P(SymmetricCheckerboard, isNumberedAsOneOfItsTurnsAndTheSameInEveryImage) {
  const target::Checkerboard board = GetParam();
  std::vector<int> first_turns;
  for (const double roll_deg : {0.0, 180.0}) {
    BoardScene scene(test_support::pinholeCamera(640, 480, 500.0));
    const auto truth = scene.add(board, {0.6, 0.0, 0.0, 15.0 * kDegree, 0.0, roll_deg * kDegree});
    const Detection detection = detect(board, scene.expose(0.6, 2.0));
    ASSERT_EQ(detection.corners.size(), truth.size());
    int turn = -1;
    for (int quarter_turns = 0; quarter_turns < 4; ++quarter_turns) {
      const std::vector<int> ids = turnedIds(board, quarter_turns);
      bool fits = board.rows == board.cols || quarter_turns % 2 == 0;
      for (std::size_t k = 0; fits && k < truth.size(); ++k) {
        fits = (detection.corners[static_cast<std::size_t>(ids[k])].px - truth[k].px).norm() < 0.2;
      }
      turn = fits ? quarter_turns : turn;
    }
    ASSERT_GE(turn, 0);
    first_turns.push_back(turn);
    // What the colours do not tell is told by the image: rows and columns run towards its lower right.
    EXPECT_LT(detection.corners.front().px.sum(), detection.corners.back().px.sum());
  }
  EXPECT_EQ((first_turns[0] + 2) % 4, first_turns[1]);
}

INSTANTIATE_TEST_SUITE_P(, SymmetricCheckerboard,
                         testing::Values(target::Checkerboard{5, 7, 0.03, 0.03}, target::Checkerboard{4, 8, 0.03, 0.03},
                                         target::Checkerboard{5, 5, 0.03, 0.03}, target::Checkerboard{6, 6, 0.03, 0.03}),
                         [](const auto& board) {
                           return std::to_string(board.param.rows) + "x" + std::to_string(board.param.cols);
                         });

TEST(Checkerboard, isFoundOnTheRecordingOfACircularFisheye) {
  TARTAN_CALIB_REQUIRE_TEST_DATA("deltille_fisheye");
  // The board has 9 x 12 squares; the recording's target.yaml counts one row and column less.
  const target::Checkerboard board{11, 8, 0.02, 0.02};
  const TargetDetector detector(board);
  int num_images = 0;
  int num_whole_boards = 0;
  for (const auto& entry : std::filesystem::directory_iterator(test_support::testData("deltille_fisheye") / "cam0")) {
    const Detection detection = detector.detect(cv::imread(entry.path().string(), cv::IMREAD_GRAYSCALE));
    ++num_images;
    num_whole_boards += detection.corners.size() == 88 ? 1 : 0;
  }
  EXPECT_EQ(num_images, 43);
  EXPECT_GE(num_whole_boards, 41);
}

}  // namespace
}  // namespace tartan_calib::detection
