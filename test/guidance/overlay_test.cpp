#include "tartan_calib/guidance/overlay.h"

#include <gtest/gtest.h>

#include <limits>
#include <opencv2/imgproc.hpp>

#include "tartan_calib/guidance/error_overlay.h"

namespace tartan_calib::guidance {
namespace {

constexpr int kWidth_px = 1200;
constexpr int kHeight_px = 900;
constexpr int kMaxWidth_px = 600;

cv::Mat grayImage() { return cv::Mat(kHeight_px, kWidth_px, CV_8UC1, cv::Scalar(128)); }

cv::Vec3b colourAt(const cv::Mat& picture, const Eigen::Vector2d& image_px) {
  return picture.at<cv::Vec3b>(static_cast<int>(image_px.y()) / 2, static_cast<int>(image_px.x()) / 2);
}

TEST(Overlay, IsBoundedInSizeAndNeverEnlarged) {
  EXPECT_EQ(drawOverlay(grayImage(), {}, kMaxWidth_px).cols, kMaxWidth_px);
  EXPECT_EQ(drawOverlay(grayImage(), {}, 4000).cols, kWidth_px);
  EXPECT_LT(drawOverlay(grayImage(), {}, kMaxWidth_px).rows, 1.3 * kMaxWidth_px * kHeight_px / kWidth_px);
}

TEST(Overlay, ShowsWhereCornersAreAndWhereNot) {
  CoverageMap coverage(kWidth_px, kHeight_px);
  coverage.addCorners(std::vector<observation::Corner>(20, {0, {225.0, 225.0}}));  // in the middle of a cell
  Overlay overlay;
  overlay.coverage = &coverage;
  const cv::Mat picture = drawOverlay(grayImage(), overlay, kMaxWidth_px);
  const cv::Vec3b seen = colourAt(picture, {225.0, 225.0});
  EXPECT_GT(seen[2], seen[0] + 30);  // yellow
  EXPECT_EQ(colourAt(picture, {900.0, 700.0}), cv::Vec3b(128, 128, 128));
}

TEST(Overlay, RingsStandAroundCorners) {
  Overlay overlay;
  overlay.corners = {{0, {600.0, 450.0}}};
  const cv::Mat picture = drawOverlay(grayImage(), overlay, kMaxWidth_px);
  EXPECT_GT(cv::norm(picture, drawOverlay(grayImage(), {}, kMaxWidth_px), cv::NORM_INF), 50.0);
}

TEST(Overlay, LinesFarBeyondTheImageDoNoHarm) {
  Overlay overlay;
  overlay.outline = {{{600.0, 450.0}, {1e9, -1e9}}, {{std::numeric_limits<double>::max(), 0.0}}, {}};
  EXPECT_EQ(drawOverlay(grayImage(), overlay, kMaxWidth_px).cols, kMaxWidth_px);
}

TEST(Overlay, LongTextIsWrittenSmallerThanThePictureIsWide) {
  Overlay overlay;
  overlay.advice = std::string(300, 'm');
  const cv::Mat picture = drawOverlay(grayImage(), overlay, kMaxWidth_px);
  const cv::Mat right_margin = picture(cv::Rect(kMaxWidth_px - 4, kMaxWidth_px * kHeight_px / kWidth_px, 4, 20));
  EXPECT_EQ(cv::norm(right_margin, cv::NORM_INF), 0.0);
}

TEST(ErrorOverlay, DrawsLinesAlongTheErrors) {
  calibration::ImageErrors errors;
  errors.corners = {{0, {600.0, 450.0}, {0.0, 2.0}, 0.0, false}};
  ErrorOverlay overlay;
  overlay.errors = &errors;
  const cv::Mat with = drawErrors(grayImage(), overlay, kMaxWidth_px);
  EXPECT_NE(colourAt(with, {600.0, 520.0}), cv::Vec3b(128, 128, 128));  // 100 px below
  EXPECT_EQ(colourAt(with, {600.0, 400.0}), cv::Vec3b(128, 128, 128));
  EXPECT_EQ(drawErrors(grayImage(), {}, kMaxWidth_px).cols, kMaxWidth_px);  // no board
}

}  // namespace
}  // namespace tartan_calib::guidance
