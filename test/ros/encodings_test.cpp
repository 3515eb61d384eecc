#include <gtest/gtest.h>
#include <sensor_msgs/CompressedImage.h>

#include <array>
#include <functional>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "ros/bag_file.h"

namespace tartan_calib::ros {
namespace {

struct EncodingCase {
  std::string encoding;
  std::function<cv::Mat(const cv::Mat& gray)> encode;
};

cv::Mat converted(const cv::Mat& gray, int code) {
  cv::Mat result;
  cv::cvtColor(gray, result, code);
  return result;
}

cv::Mat withChroma(const cv::Mat& gray, bool luma_first) {
  const cv::Mat chroma(gray.size(), CV_8UC1, cv::Scalar(77));
  cv::Mat result;
  cv::merge(luma_first ? std::vector<cv::Mat>{gray, chroma} : std::vector<cv::Mat>{chroma, gray}, result);
  return result;
}

cv::Mat scaled16(const cv::Mat& gray, double scale) {
  cv::Mat result;
  gray.convertTo(result, CV_16U, scale);
  return result;
}

class GrayEncoding : public ::testing::TestWithParam<EncodingCase> {};

TEST_P(GrayEncoding, GivesBackTheGreyImageThatWasStored) {
  const BagFile bag;
  store<sensor_msgs::Image>(bag.path(), {message(GetParam().encode(grayRamp()), GetParam().encoding)});
  const auto images = readAll(bag.path());
  ASSERT_EQ(images.size(), 1U);
  EXPECT_EQ(images.front().stamp_ns, kStart);
  const cv::Mat gray = images.front().load();
  ASSERT_EQ(gray.type(), CV_8UC1);
  ASSERT_EQ(gray.size(), cv::Size(kWidth, kHeight));
  EXPECT_EQ(largestDifference(gray, grayRamp()), 0.0);
}

INSTANTIATE_TEST_SUITE_P(
    All, GrayEncoding,
    ::testing::Values(EncodingCase{"mono8", [](const cv::Mat& gray) { return gray; }},
                      EncodingCase{"8UC1", [](const cv::Mat& gray) { return gray; }},
                      EncodingCase{"mono16", [](const cv::Mat& gray) { return scaled16(gray, 256.0); }},
                      EncodingCase{"16UC1", [](const cv::Mat& gray) { return scaled16(gray, 256.0); }},
                      EncodingCase{"bgr8", [](const cv::Mat& gray) { return converted(gray, cv::COLOR_GRAY2BGR); }},
                      EncodingCase{"rgb8", [](const cv::Mat& gray) { return converted(gray, cv::COLOR_GRAY2BGR); }},
                      EncodingCase{"8UC3", [](const cv::Mat& gray) { return converted(gray, cv::COLOR_GRAY2BGR); }},
                      EncodingCase{"bgra8", [](const cv::Mat& gray) { return converted(gray, cv::COLOR_GRAY2BGRA); }},
                      EncodingCase{"rgba8", [](const cv::Mat& gray) { return converted(gray, cv::COLOR_GRAY2BGRA); }},
                      EncodingCase{"yuv422", [](const cv::Mat& gray) { return withChroma(gray, false); }},
                      EncodingCase{"yuv422_yuy2", [](const cv::Mat& gray) { return withChroma(gray, true); }}),
    [](const auto& test) { return test.param.encoding; });

/// Image of one colour, (blue, green, red).
cv::Mat plain(const cv::Scalar& color) { return cv::Mat(kHeight, kWidth, CV_8UC3, color); }

struct ColorCase {
  std::string encoding;
  std::function<cv::Mat(const cv::Mat& bgr)> encode;
};

/// Mosaic whose pixel (row, col) shows channel channels[row % 2][col % 2] of a BGR image.
cv::Mat mosaic(const cv::Mat& bgr, const std::array<std::array<int, 2>, 2>& channels) {
  cv::Mat result(bgr.size(), CV_8UC1);
  for (int row = 0; row < bgr.rows; ++row) {
    for (int col = 0; col < bgr.cols; ++col) {
      const int channel = channels[static_cast<std::size_t>(row % 2)][static_cast<std::size_t>(col % 2)];
      result.at<std::uint8_t>(row, col) = bgr.at<cv::Vec3b>(row, col)[channel];
    }
  }
  return result;
}

class ColorEncoding : public ::testing::TestWithParam<ColorCase> {};

TEST_P(ColorEncoding, WeighsRedGreenAndBlueAsGreyImagesDo) {
  constexpr double kRed = 200.0;
  constexpr double kGreen = 60.0;
  constexpr double kBlue = 10.0;
  constexpr double kLuma = 0.299 * kRed + 0.587 * kGreen + 0.114 * kBlue;
  const BagFile bag;
  const cv::Mat encoded = GetParam().encode(plain(cv::Scalar(kBlue, kGreen, kRed)));
  store<sensor_msgs::Image>(bag.path(), {message(encoded, GetParam().encoding)});
  const cv::Mat gray = readAll(bag.path()).front().load();
  double low = 0.0;
  double high = 0.0;
  cv::minMaxIdx(gray, &low, &high);
  constexpr double kIntegerArithmetic = 2.0;  // OpenCV truncates twice in Bayer patterns; other patterns are 10 to 60 off
  EXPECT_NEAR(low, kLuma, kIntegerArithmetic);
  EXPECT_NEAR(high, kLuma, kIntegerArithmetic);
}

constexpr int kB = 0;
constexpr int kG = 1;
constexpr int kR = 2;

INSTANTIATE_TEST_SUITE_P(
    All, ColorEncoding,
    ::testing::Values(ColorCase{"bgr8", [](const cv::Mat& bgr) { return bgr; }},
                      ColorCase{"rgb8", [](const cv::Mat& bgr) { return converted(bgr, cv::COLOR_BGR2RGB); }},
                      ColorCase{"bgra8", [](const cv::Mat& bgr) { return converted(bgr, cv::COLOR_BGR2BGRA); }},
                      ColorCase{"rgba8", [](const cv::Mat& bgr) { return converted(bgr, cv::COLOR_BGR2RGBA); }},
                      ColorCase{"bayer_rggb8",
                                [](const cv::Mat& bgr) {
                                  return mosaic(bgr, {{{kR, kG}, {kG, kB}}});
                                }},
                      ColorCase{"bayer_bggr8",
                                [](const cv::Mat& bgr) {
                                  return mosaic(bgr, {{{kB, kG}, {kG, kR}}});
                                }},
                      ColorCase{"bayer_gbrg8",
                                [](const cv::Mat& bgr) {
                                  return mosaic(bgr, {{{kG, kB}, {kR, kG}}});
                                }},
                      ColorCase{"bayer_grbg8",
                                [](const cv::Mat& bgr) {
                                  return mosaic(bgr, {{{kG, kR}, {kB, kG}}});
                                }}),
    [](const auto& test) { return test.param.encoding; });

TEST(SixteenBits, OfATwelveBitSensorAreScaledByTheImagesOwnRangeAndToldOfOnce) {
  const BagFile bag;
  cv::Mat twelve_bits = scaled16(grayRamp(), 10.0) + 300;
  store<sensor_msgs::Image>(bag.path(), {message(twelve_bits, "mono16"), message(twelve_bits, "mono16", kStart + kMs)});
  std::vector<std::string> notices;
  io::RecordingOptions options;
  options.notice = [&](const std::string& text) { notices.push_back(text); };
  double low = 0.0;
  double high = 0.0;
  cv::minMaxIdx(readAll(bag.path(), options).front().load(), &low, &high);
  EXPECT_EQ(low, 0.0);
  EXPECT_EQ(high, 255.0);
  ASSERT_EQ(notices.size(), 1U);
  EXPECT_NE(notices.front().find("own range"), std::string::npos) << notices.front();
}

TEST(SixteenBits, AreReadInTheByteOrderThatTheMessageNames) {
  const BagFile bag;
  cv::Mat swapped = scaled16(grayRamp(), 1.0);  // the grey value in the second byte, which is the upper one after swapping
  sensor_msgs::Image image = message(swapped, "mono16");
  image.is_bigendian = 1;
  store<sensor_msgs::Image>(bag.path(), {image});
  EXPECT_EQ(largestDifference(readAll(bag.path()).front().load(), grayRamp()), 0.0);
}

TEST(BagReader, SkipsThePaddingAtTheEndOfRows) {
  const BagFile bag;
  cv::Mat padded(kHeight, kWidth + 8, CV_8UC1, cv::Scalar(255));
  grayRamp().copyTo(padded.colRange(0, kWidth));
  sensor_msgs::Image image = message(padded, "mono8");
  image.width = kWidth;
  store<sensor_msgs::Image>(bag.path(), {image});
  EXPECT_EQ(largestDifference(readAll(bag.path()).front().load(), grayRamp()), 0.0);
}

class CompressedFormat : public ::testing::TestWithParam<std::pair<std::string, std::string>> {};

TEST_P(CompressedFormat, IsDecodedWhateverTheDriverWritesAroundItsName) {
  const auto& [format, extension] = GetParam();
  const BagFile bag;
  sensor_msgs::CompressedImage image;
  image.header.stamp.fromNSec(static_cast<std::uint64_t>(kStart));
  image.format = format;
  cv::imencode(extension, converted(grayRamp(), cv::COLOR_GRAY2BGR), image.data);
  store<sensor_msgs::CompressedImage>(bag.path(), {image});
  const cv::Mat gray = readAll(bag.path()).front().load();
  ASSERT_EQ(gray.size(), cv::Size(kWidth, kHeight));
  constexpr double kJpegLoss = 8.0;  // at OpenCV's default quality of 95
  EXPECT_LE(largestDifference(gray, grayRamp()), extension == ".png" ? 0.0 : kJpegLoss);
}

INSTANTIATE_TEST_SUITE_P(All, CompressedFormat,
                         ::testing::Values(std::make_pair("jpeg", ".jpg"), std::make_pair("png", ".png"),
                                           std::make_pair("rgb8; jpeg compressed bgr8", ".jpg"),
                                           std::make_pair("mono8; PNG compressed ", ".png")));

}  // namespace
}  // namespace tartan_calib::ros
