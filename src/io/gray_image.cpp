#include "tartan_calib/io/gray_image.h"

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "image_bytes.h"
#include "tartan_calib/error.h"

namespace tartan_calib::io {
namespace {

/// A span of 14 bits leaves 64 grey levels in the upper byte, about the least that sub-pixel work stands without loss.
constexpr double kFewLevels = 16384.0;

struct Range {
  double low = 0.0;
  double high = 0.0;
};

Range valueRange(const cv::Mat& image) {
  Range range;
  cv::minMaxIdx(image, &range.low, &range.high);
  return range;
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
