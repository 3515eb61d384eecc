#include "tartan_calib/io/gray_image.h"

#include <algorithm>
#include <limits>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "image_bytes.h"
#include "tartan_calib/error.h"

namespace tartan_calib::io {
namespace {

/// A span of 14 bits leaves 64 grey levels in the upper byte, about the least that sub-pixel work stands without loss.
constexpr double kFewLevels = 16384.0;

/// Share of the pixels that may lie beyond each end of the range: hot and dead ones, and the numbers that some drivers write
/// into a row. A board that can be read covers more.
constexpr double kStrayShare = 0.001;

struct Range {
  double low = 0.0;
  double high = 0.0;
};

Range valueRange(const cv::Mat& gray16) {
  if (gray16.empty()) {
    return {};
  }
  std::vector<std::size_t> counts(std::numeric_limits<std::uint16_t>::max() + 1);
  for (int row = 0; row < gray16.rows; ++row) {
    const auto* values = gray16.ptr<std::uint16_t>(row);
    std::for_each(values, values + gray16.cols, [&counts](std::uint16_t value) { ++counts[value]; });
  }
  const auto num_stray = static_cast<std::size_t>(kStrayShare * static_cast<double>(gray16.total()));
  const auto end = [num_stray](auto count) {
    for (std::size_t num_beyond = *count; num_beyond <= num_stray; num_beyond += *count) {
      ++count;
    }
    return count;
  };
  return {static_cast<double>(end(counts.begin()) - counts.begin()),
          static_cast<double>(counts.rend() - end(counts.rbegin()) - 1)};
}

cv::Mat reduceTo8Bits(const cv::Mat& gray16) {
  constexpr double kMax8 = 255.0;
  constexpr double kLevelsPerByteStep = 256.0;
  const Range range = valueRange(gray16);
  const double span = range.high - range.low;
  cv::Mat gray8;
  if (span >= kFewLevels) {
    gray16.convertTo(gray8, CV_8U, 1.0 / kLevelsPerByteStep);
  } else {
    const double scale = span > 0.0 ? kMax8 / span : 0.0;
    gray16.convertTo(gray8, CV_8U, scale, -range.low * scale);
  }
  return gray8;
}

/// OpenCV names a Bayer pattern by the second and third pixel of the second row, ROS by the first two of the first row.
cv::ColorConversionCodes conversion(PixelLayout layout) {
  switch (layout) {
    case PixelLayout::kBgr:
      return cv::COLOR_BGR2GRAY;
    case PixelLayout::kRgb:
      return cv::COLOR_RGB2GRAY;
    case PixelLayout::kBgra:
      return cv::COLOR_BGRA2GRAY;
    case PixelLayout::kRgba:
      return cv::COLOR_RGBA2GRAY;
    case PixelLayout::kBayerRggb:
      return cv::COLOR_BayerBG2GRAY;
    case PixelLayout::kBayerBggr:
      return cv::COLOR_BayerRG2GRAY;
    case PixelLayout::kBayerGbrg:
      return cv::COLOR_BayerGR2GRAY;
    case PixelLayout::kBayerGrbg:
      return cv::COLOR_BayerGB2GRAY;
    case PixelLayout::kUyvy:
      return cv::COLOR_YUV2GRAY_UYVY;
    case PixelLayout::kYuyv:
      return cv::COLOR_YUV2GRAY_YUYV;
    case PixelLayout::kGray:
      break;
  }
  throw Error("grey images need no conversion");
}

}  // namespace

cv::Mat toGray8(const cv::Mat& pixels, PixelLayout layout) {
  if (layout == PixelLayout::kGray) {
    return pixels.depth() == CV_16U ? reduceTo8Bits(pixels) : pixels;
  }
  cv::Mat gray;
  cv::cvtColor(pixels, gray, conversion(layout));
  return gray;
}

bool spansFewLevels(const cv::Mat& gray16) {
  const Range range = valueRange(gray16);
  return range.high - range.low < kFewLevels;
}

cv::Mat decodeGray(const std::vector<std::uint8_t>& bytes) {
  if (bytes.empty()) {
    throw InputError("the file is empty");
  }
  if (endsEarly(bytes)) {
    throw InputError("the file is cut off");
  }
  cv::Mat gray;
  try {
    gray = cv::imdecode(bytes, cv::IMREAD_GRAYSCALE | cv::IMREAD_ANYDEPTH);
  } catch (const cv::Exception& error) {
    throw InputError("not a readable image: " + error.err);
  }
  if (gray.empty() || (gray.depth() != CV_8U && gray.depth() != CV_16U)) {
    throw InputError("not a readable image of 8 or 16 bits");
  }
  return gray;
}

}  // namespace tartan_calib::io
