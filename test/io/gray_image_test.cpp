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

TEST(DecodeGrayOf, anythingElseSaysThatItIsNoImage) {
  expectMessage<InputError>([] { decodeGray({}); }, {"not a readable image"});
  expectMessage<InputError>([] { decodeGray(std::vector<std::uint8_t>(100, 'x')); }, {"not a readable image"});
}

}  // namespace
}  // namespace tartan_calib::io
