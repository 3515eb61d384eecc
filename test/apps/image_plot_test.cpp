#include "common/image_plot.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <limits>

#include "common/picture_file.h"
#include "support/temporary_folder.h"
#include "tartan_calib/error.h"

namespace tartan_calib::apps {
namespace {

constexpr int kWidth = 760;  ///< drawn one to one, its upper left corner at (64, 46)
constexpr int kHeight = 380;
constexpr int kLeft = 64;
constexpr int kTop = 46;

/// Amounts that grow from 0 at the left edge to 1 at the right.
ImageField ramp() {
  ImageField field;
  field.spacing_px = 20.0;
  field.values = cv::Mat1f(20, 39);
  for (int x = 0; x < field.values.cols; ++x) {
    field.values.col(x).setTo(20.0 * x / (kWidth - 1));
  }
  return field;
}

cv::Vec3b pixel(const cv::Mat& picture, int u, int v) { return picture.at<cv::Vec3b>(kTop + v, kLeft + u); }

TEST(RoundUp, GivesTheNextOfOneTwoFive) {
  EXPECT_DOUBLE_EQ(roundUp(0.3), 0.5);
  EXPECT_DOUBLE_EQ(roundUp(0.2), 0.2);
  EXPECT_DOUBLE_EQ(roundUp(0.0011), 0.002);
  EXPECT_DOUBLE_EQ(roundUp(51.0), 100.0);
  EXPECT_DOUBLE_EQ(roundUp(1000.0), 1000.0);
}

TEST(ImagePlot, ColoursStandForAmountsAndGreyForNone) {
  ImageField field = ramp();
  field.values.rowRange(10, 20).setTo(std::numeric_limits<float>::quiet_NaN());
  ImagePlot plot("ramp", kWidth, kHeight);
  plot.drawField(field, 1.0, "px");
  const cv::Mat picture = plot.picture();
  for (const double share : {0.25, 0.5, 0.75}) {
    const cv::Scalar expected = ImagePlot::colourOf(share);
    const cv::Vec3b found = pixel(picture, static_cast<int>(share * kWidth), 90);
    for (int c = 0; c < 3; ++c) {
      EXPECT_NEAR(found[c], expected[c], 3.0);
    }
    EXPECT_EQ(pixel(picture, static_cast<int>(share * kWidth), 300), cv::Vec3b(200, 200, 200));
  }
}

TEST(ImagePlot, ColoursEndAtTheLargestAmount) {
  EXPECT_NE(ImagePlot::colourOf(0.0), ImagePlot::colourOf(1.0));
  EXPECT_EQ(ImagePlot::colourOf(-1.0), ImagePlot::colourOf(0.0));
  for (const double share : {1.1, 1e12}) {
    EXPECT_EQ(ImagePlot::colourOf(share), ImagePlot::colourOf(1.0)) << share;
  }
}

TEST(ImagePlot, AContourIsWhereTheFieldHasItsLevel) {
  ImagePlot plot("ramp", kWidth, kHeight);
  plot.drawField(ramp(), 1.0, "px");
  const cv::Mat before = plot.picture();
  plot.drawContours(ramp(), {0.5}, 1.0);
  const cv::Mat after = plot.picture();
  const int v = 60;  // away from the contour's number
  EXPECT_GT(cv::norm(pixel(after, kWidth / 2, v), pixel(before, kWidth / 2, v)), 50.0);
  EXPECT_EQ(pixel(after, kWidth / 2 - 6, v), pixel(before, kWidth / 2 - 6, v));
  EXPECT_EQ(pixel(after, kWidth / 2 + 6, v), pixel(before, kWidth / 2 + 6, v));
}

/// How many rows of a contour are hidden by what is drawn over it: its number.
int numHiddenRows(const cv::Mat& with_contours, const cv::Mat& without, int u) {
  int num_rows = 0;
  for (int v = 0; v < kHeight; ++v) {
    num_rows += cv::norm(pixel(with_contours, u, v), pixel(without, u, v)) < 50.0 ? 1 : 0;
  }
  return num_rows;
}

TEST(ImagePlot, EveryContourHasItsNumberWhereTheLinesAreClose) {
  ImagePlot plot("ramp", kWidth, kHeight);
  plot.drawField(ramp(), 1.0, "px");
  const cv::Mat before = plot.picture();
  const std::vector<double> levels = {0.5, 0.51, 0.52};
  plot.drawContours(ramp(), levels, 1.0);
  for (const double level : levels) {
    EXPECT_GT(numHiddenRows(plot.picture(), before, static_cast<int>(level * kWidth)), 5) << level;
  }
}

TEST(ImagePlot, AVectorIsDrawnAtItsPlaceAndMagnified) {
  ImagePlot plot("vector", kWidth, kHeight);
  plot.drawVector({100.0, 100.0}, {0.5, 0.0}, 100.0, {0.0, 0.0, 255.0});
  const cv::Mat picture = plot.picture();
  const cv::Vec3b white(255, 255, 255);
  EXPECT_NE(pixel(picture, 125, 100), white);
  EXPECT_NE(pixel(picture, 148, 100), white);
  EXPECT_EQ(pixel(picture, 155, 100), white);
  EXPECT_EQ(pixel(picture, 125, 105), white);
}

TEST(PictureFile, ArrangesTwoInARow) {
  const cv::Mat tile(30, 40, CV_8UC3, cv::Scalar::all(7));
  EXPECT_EQ(arrange({tile}).size(), cv::Size(40, 30));
  EXPECT_EQ(arrange({tile, tile}).size(), cv::Size(80, 30));
  const cv::Mat three = arrange({tile, tile, tile});
  EXPECT_EQ(three.size(), cv::Size(80, 60));
  EXPECT_EQ(three.at<cv::Vec3b>(45, 20), cv::Vec3b(7, 7, 7));
  EXPECT_EQ(three.at<cv::Vec3b>(45, 60), cv::Vec3b(255, 255, 255));
}

TEST(PictureFile, HasToBeAPng) {
  const test_support::TemporaryFolder folder;
  const cv::Mat picture(30, 40, CV_8UC3, cv::Scalar::all(7));
  savePng(folder.file("map.png"), picture);
  EXPECT_TRUE(std::filesystem::exists(folder.file("map.png")));
  EXPECT_THROW(savePng(folder.file("map.jpg"), picture), InputError);
  EXPECT_THROW(checkPngName("png"), InputError);
}

}  // namespace
}  // namespace tartan_calib::apps
