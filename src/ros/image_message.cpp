#include "tartan_calib/ros/image_message.h"

#include <algorithm>
#include <array>
#include <cctype>

#include "tartan_calib/error.h"
#include "tartan_calib/io/gray_image.h"

namespace tartan_calib::ros {
namespace {

using io::PixelLayout;

struct Encoding {
  const char* name;
  PixelLayout layout;
  int cv_type;
};

constexpr std::array<Encoding, 18> kEncodings = {{
    {"mono8", PixelLayout::kGray, CV_8UC1},
    {"8UC1", PixelLayout::kGray, CV_8UC1},
    {"mono16", PixelLayout::kGray, CV_16UC1},
    {"16UC1", PixelLayout::kGray, CV_16UC1},
    {"bgr8", PixelLayout::kBgr, CV_8UC3},
    {"8UC3", PixelLayout::kBgr, CV_8UC3},
    {"rgb8", PixelLayout::kRgb, CV_8UC3},
    {"bgra8", PixelLayout::kBgra, CV_8UC4},
    {"8UC4", PixelLayout::kBgra, CV_8UC4},
    {"rgba8", PixelLayout::kRgba, CV_8UC4},
    {"bayer_rggb8", PixelLayout::kBayerRggb, CV_8UC1},
    {"bayer_bggr8", PixelLayout::kBayerBggr, CV_8UC1},
    {"bayer_gbrg8", PixelLayout::kBayerGbrg, CV_8UC1},
    {"bayer_grbg8", PixelLayout::kBayerGrbg, CV_8UC1},
    {"yuv422", PixelLayout::kUyvy, CV_8UC2},
    {"yuv422_yuy2", PixelLayout::kYuyv, CV_8UC2},
    // Later names of the two orders.
    {"uyvy", PixelLayout::kUyvy, CV_8UC2},
    {"yuyv", PixelLayout::kYuyv, CV_8UC2},
}};

const Encoding* findEncoding(const std::string& name) {
  const auto found =
      std::find_if(kEncodings.begin(), kEncodings.end(), [&](const Encoding& encoding) { return name == encoding.name; });
  return found == kEncodings.end() ? nullptr : &*found;
}

/// The message's data as an image, without a copy: valid while the message lives, and not to be written to.
cv::Mat pixelsOf(const sensor_msgs::Image& message, int cv_type) {
  const std::size_t row_bytes = static_cast<std::size_t>(message.width) * static_cast<std::size_t>(CV_ELEM_SIZE(cv_type));
  const std::size_t step = message.step;
  const bool has_pixels = message.width > 0 && message.height > 0;
  if (!has_pixels || step < row_bytes || message.data.size() < step * (message.height - 1) + row_bytes) {
    throw InputError("image of " + std::to_string(message.width) + "x" + std::to_string(message.height) + " " +
                     message.encoding + " with rows of " + std::to_string(step) + " bytes has only " +
                     std::to_string(message.data.size()) + " bytes of data");
  }
  auto* data = const_cast<std::uint8_t*>(message.data.data());  // cv::Mat has no constructor for constant data
  return cv::Mat(static_cast<int>(message.height), static_cast<int>(message.width), cv_type, data, step);
}

void swapBytes(cv::Mat& gray16) {
  gray16.forEach<std::uint16_t>(
      [](std::uint16_t& value, const int*) { value = static_cast<std::uint16_t>((value << 8) | (value >> 8)); });
}

bool hostIsBigEndian() {
  const std::uint16_t one = 1;
  return *reinterpret_cast<const std::uint8_t*>(&one) == 0;
}

std::string lowerCase(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char letter) { return static_cast<char>(std::tolower(letter)); });
  return text;
}

}  // namespace

bool isSupportedEncoding(const std::string& encoding) { return findEncoding(encoding) != nullptr; }

bool isSupportedFormat(const std::string& format) {
  const std::string name = lowerCase(format);
  const auto names = [&](const char* part) { return name.find(part) != std::string::npos; };
  return (names("jpeg") || names("jpg") || names("png")) && !names("compresseddepth");
}

std::string supportedEncodings() {
  std::string names;
  for (const Encoding& encoding : kEncodings) {
    names += (names.empty() ? "" : ", ") + std::string(encoding.name);
  }
  return names;
}

std::string supportedFormats() { return "jpeg, png"; }

cv::Mat grayImage(const sensor_msgs::Image& message) {
  const Encoding* encoding = findEncoding(message.encoding);
  if (encoding == nullptr) {
    throw InputError("encoding " + message.encoding + " is not supported");
  }
  const cv::Mat pixels = pixelsOf(message, encoding->cv_type);
  if (encoding->cv_type == CV_16UC1) {
    cv::Mat gray = pixels.clone();
    if ((message.is_bigendian != 0) != hostIsBigEndian()) {
      swapBytes(gray);
    }
    return gray;
  }
  const cv::Mat gray = io::toGray8(pixels, encoding->layout);
  return gray.data == pixels.data ? gray.clone() : gray;
}

cv::Mat grayImage(const sensor_msgs::CompressedImage& message) { return io::decodeGray(message.data); }

}  // namespace tartan_calib::ros
