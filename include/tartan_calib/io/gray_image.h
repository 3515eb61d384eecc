#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <vector>

namespace tartan_calib::io {

/// Meaning of the channels of an image in memory. Channels have 8 bits, those of kGray 8 or 16.
enum class PixelLayout {
  kGray,
  kBgr,
  kRgb,
  kBgra,
  kRgba,
  kBayerRggb,  ///< one channel; named by the first two pixels of the first two rows
  kBayerBggr,
  kBayerGbrg,
  kBayerGrbg,
  kUyvy,  ///< two channels, 4:2:2
  kYuyv,
};

/// CV_8UC1 of an image; may share memory with it. 16 bits become 8 by the image's own range where spansFewLevels, else by
/// their upper byte. A few stray values, such as hot pixels, are not part of the range.
cv::Mat toGray8(const cv::Mat& pixels, PixelLayout layout);

/// True where the values of a 16-bit image span so little of 16 bits that the upper byte alone would lose contrast, as those
/// of 10, 12 and 14-bit sensors do.
bool spansFewLevels(const cv::Mat& gray16);

/// Decodes the bytes of an image file to grey of 8 or 16 bits. Throws InputError where they are none, without naming the
/// file.
cv::Mat decodeGray(const std::vector<std::uint8_t>& bytes);

}  // namespace tartan_calib::io
