#include "tartan_calib/io/gray_image.h"

#include <gtest/gtest.h>

#include <opencv2/imgcodecs.hpp>

#include "support/expect_message.h"
#include "tartan_calib/error.h"

namespace tartan_calib::io {
namespace {

using test_support::expectMessage;

/// A file with some structure in its image, so that the coded pixels take most of it.
std::vector<std::uint8_t> fileOf(const std::string& extension, int type) {
  cv::Mat image(40, 60, type);
  cv::randu(image, 0, 255);
  std::vector<std::uint8_t> bytes;
  cv::imencode(extension, image, bytes);
  return bytes;
}

struct File {
  const char* extension;
  int type;
};

class DecodeGray : public testing::TestWithParam<File> {};

TEST_P(DecodeGray, readsWholeFiles) {
  const cv::Mat gray = decodeGray(fileOf(GetParam().extension, GetParam().type));
  EXPECT_EQ(gray.size(), cv::Size(60, 40));
  EXPECT_EQ(gray.channels(), 1);
}

TEST_P(DecodeGray, saysOfAFileCutOffAnywhereThatItIsAndNothingElse) {
  const std::vector<std::uint8_t> whole = fileOf(GetParam().extension, GetParam().type);
  constexpr std::size_t kSignatureBytes = 8;
  testing::internal::CaptureStderr();
  for (std::size_t size = kSignatureBytes; size < whole.size(); size += 7) {
    const std::vector<std::uint8_t> part(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size));
    expectMessage<InputError>([&] { decodeGray(part); }, {"cut off"});
  }
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

INSTANTIATE_TEST_SUITE_P(, DecodeGray,
                         testing::Values(File{".png", CV_8UC1}, File{".png", CV_16UC1}, File{".png", CV_8UC3},
                                         File{".jpg", CV_8UC1}, File{".jpg", CV_8UC3}),
                         [](const auto& file) {
                           return std::string(file.param.extension + 1) + std::to_string(file.param.type);
                         });

TEST(DecodeGrayOf, aJpegWithAThumbnailSeesTheEndOfThePictureNotOfTheThumbnail) {
  const std::vector<std::uint8_t> whole = fileOf(".jpg", CV_8UC1);
  const std::vector<std::uint8_t> thumbnail = {0xFF, 0xE1, 0x00, 0x06, 0xFF, 0xD8, 0xFF, 0xD9};
  std::vector<std::uint8_t> bytes = whole;
  bytes.insert(bytes.begin() + 2, thumbnail.begin(), thumbnail.end());
  EXPECT_EQ(decodeGray(bytes).rows, 40);
  bytes.resize(bytes.size() - 2);
  expectMessage<InputError>([&] { decodeGray(bytes); }, {"cut off"});
}

/// A ramp of 12 bits that is large enough for stray pixels.
cv::Mat ramp12() {
  cv::Mat ramp(100, 128, CV_16UC1);
  for (int row = 0; row < ramp.rows; ++row) {
    for (int col = 0; col < ramp.cols; ++col) {
      ramp.at<std::uint16_t>(row, col) = static_cast<std::uint16_t>(1000 + 20 * col);
    }
  }
  return ramp;
}

TEST(ToGray8, scalesTwelveBitsByTheirRangeWhateverSinglePixelsSay) {
  const cv::Mat ramp = ramp12();
  const cv::Mat expected = toGray8(ramp, PixelLayout::kGray);
  EXPECT_EQ(expected.at<std::uint8_t>(50, 0), 0);
  EXPECT_EQ(expected.at<std::uint8_t>(50, 127), 255);
  cv::Mat with_stray = ramp.clone();
  constexpr int kNumStray = 12;  // of 12 800
  for (int i = 0; i < kNumStray; ++i) {
    with_stray.at<std::uint16_t>(0, i) = i % 2 == 0 ? 65535 : 0;
  }
  EXPECT_TRUE(spansFewLevels(with_stray));
  const cv::Mat gray = toGray8(with_stray, PixelLayout::kGray);
  EXPECT_EQ(cv::norm(gray.rowRange(1, gray.rows), expected.rowRange(1, gray.rows), cv::NORM_INF), 0.0);
  EXPECT_EQ(gray.at<std::uint8_t>(0, 0), 255);
  EXPECT_EQ(gray.at<std::uint8_t>(0, 1), 0);
}

TEST(ToGray8, takesTheUpperByteOfRealSixteenBits) {
  const cv::Mat ramp = ramp12() * 10;
  EXPECT_FALSE(spansFewLevels(ramp));
  EXPECT_EQ(toGray8(ramp, PixelLayout::kGray).at<std::uint8_t>(0, 100), (1000 + 20 * 100) * 10 / 256);
}

TEST(ToGray8, makesAnImageOfOneValueDark) {
  EXPECT_EQ(cv::countNonZero(toGray8(cv::Mat(40, 60, CV_16UC1, cv::Scalar(4095)), PixelLayout::kGray)), 0);
}

TEST(DecodeGrayOf, anythingElseSaysThatItIsNoImage) {
  expectMessage<InputError>([] { decodeGray({}); }, {"the file is empty"});
  expectMessage<InputError>([] { decodeGray(std::vector<std::uint8_t>(100, 'x')); }, {"not a readable image"});
}

}  // namespace
}  // namespace tartan_calib::io
