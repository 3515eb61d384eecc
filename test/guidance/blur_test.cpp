#include "tartan_calib/guidance/blur.h"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/imgproc.hpp>

#include "tartan_calib/target/target.h"

namespace tartan_calib::guidance {
namespace {

constexpr int kSquare_px = 40;
constexpr int kMargin_px = 60;

struct Drawn {
  cv::Mat gray;
  std::vector<observation::Corner> corners;
};

target::Checkerboard board() {
  target::Checkerboard board;
  board.rows = 5;
  board.cols = 7;
  board.row_spacing_m = board.col_spacing_m = 0.03;
  return board;
}

/// Its inner corners lie between pixels; turned by that angle about the middle of the image.
Drawn drawBoard(double angle_deg) {
  const target::Checkerboard size = board();
  Drawn drawn;
  drawn.gray = cv::Mat(2 * kMargin_px + (size.rows + 1) * kSquare_px, 2 * kMargin_px + (size.cols + 1) * kSquare_px, CV_8UC1,
                       cv::Scalar(220));
  for (int row = 0; row <= size.rows; ++row) {
    for (int col = row % 2; col <= size.cols; col += 2) {
      drawn.gray(cv::Rect(kMargin_px + col * kSquare_px, kMargin_px + row * kSquare_px, kSquare_px, kSquare_px)).setTo(30);
    }
  }
  const cv::Mat turn = cv::getRotationMatrix2D(
      {0.5f * static_cast<float>(drawn.gray.cols - 1), 0.5f * static_cast<float>(drawn.gray.rows - 1)}, angle_deg, 1.0);
  cv::warpAffine(drawn.gray, drawn.gray, turn, drawn.gray.size(), cv::INTER_LINEAR, cv::BORDER_CONSTANT, cv::Scalar(220));
  for (int id = 0; id < size.rows * size.cols; ++id) {
    const int col = id % size.cols;
    const int row = id / size.cols;
    const double x = kMargin_px + (col + 1) * kSquare_px - 0.5;
    const double y = kMargin_px + (row + 1) * kSquare_px - 0.5;
    const cv::Mat at_px = turn * cv::Mat1d({3, 1}, {x, y, 1.0});
    drawn.corners.push_back({id, {at_px.at<double>(0), at_px.at<double>(1)}});
  }
  return drawn;
}

class GaussianBlur : public testing::TestWithParam<double> {};

TEST_P(GaussianBlur, IsMeasuredWhicheverWayTheBoardLies) {
  for (const double angle_deg : {0.0, 20.0, 45.0}) {
    Drawn drawn = drawBoard(angle_deg);
    cv::GaussianBlur(drawn.gray, drawn.gray, {}, GetParam());
    const auto blur_px = edgeBlur(drawn.gray, drawn.corners, board());
    ASSERT_TRUE(blur_px);
    constexpr double kSlack_px = 0.1;          // slopes are those over a pixel
    constexpr double kInterpolation_px = 0.5;  // that turning the drawing adds
    EXPECT_GT(*blur_px, GetParam() - kSlack_px) << angle_deg;
    EXPECT_LT(*blur_px, std::hypot(GetParam(), kInterpolation_px) + kSlack_px) << angle_deg;
  }
}

INSTANTIATE_TEST_SUITE_P(Sizes, GaussianBlur, testing::Values(0.7, 1.0, 2.0, 3.0));

TEST(EdgeBlur, OfMotionIsThatAcrossTheBlurredEdges) {
  constexpr int kMotion_px = 9;
  Drawn drawn = drawBoard(0.0);
  cv::blur(drawn.gray, drawn.gray, {kMotion_px, 1});
  const auto blur_px = edgeBlur(drawn.gray, drawn.corners, board());
  ASSERT_TRUE(blur_px);
  EXPECT_NEAR(*blur_px, 0.4 * kMotion_px, 0.2);  // grey levels are whole numbers
}

TEST(EdgeBlur, IsUnknownWithoutEdges) {
  const Drawn drawn = drawBoard(0.0);
  EXPECT_FALSE(edgeBlur(drawn.gray, {}, board()));
  EXPECT_FALSE(edgeBlur(cv::Mat(drawn.gray.size(), CV_8UC1, cv::Scalar(128)), drawn.corners, board()));
  EXPECT_FALSE(edgeBlur(drawn.gray, drawn.corners, target::CircleGrid{}));
}

TEST(EdgeBlur, LeavesOutEdgesBeyondTheImage) {
  const Drawn drawn = drawBoard(0.0);
  const cv::Mat part = drawn.gray(cv::Rect(0, 0, drawn.gray.cols, drawn.gray.rows / 2)).clone();
  EXPECT_TRUE(edgeBlur(part, drawn.corners, board()));
}

}  // namespace
}  // namespace tartan_calib::guidance
