#include "image_bytes.h"

#include <algorithm>
#include <array>
#include <cstddef>

namespace tartan_calib::io {
namespace {

using Bytes = std::vector<std::uint8_t>;

template <std::size_t kSize>
bool hasAt(const Bytes& bytes, std::size_t at, const std::array<std::uint8_t, kSize>& expected) {
  return at + kSize <= bytes.size() &&
         std::equal(expected.begin(), expected.end(), bytes.begin() + static_cast<std::ptrdiff_t>(at));
}

/// A big-endian number of `count` bytes; the caller knows that they are there.
std::size_t numberAt(const Bytes& bytes, std::size_t at, std::size_t count) {
  std::size_t number = 0;
  for (std::size_t i = 0; i < count; ++i) {
    number = (number << 8U) | bytes[at + i];
  }
  return number;
}

constexpr std::array<std::uint8_t, 8> kPngBegin = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1A, '\n'};
constexpr std::array<std::uint8_t, 4> kPngEnd = {'I', 'E', 'N', 'D'};

/// PNG is a row of chunks: 4 bytes of length, 4 of type, the data, 4 of checksum (ISO/IEC 15948, 5.3).
bool pngEndsEarly(const Bytes& bytes) {
  constexpr std::size_t kLengthBytes = 4;
  constexpr std::size_t kChunkBytes = 12;  // besides its data
  for (std::size_t at = kPngBegin.size(); at + kChunkBytes <= bytes.size();) {
    if (hasAt(bytes, at + kLengthBytes, kPngEnd)) {
      return false;
    }
    at += kChunkBytes + numberAt(bytes, at, kLengthBytes);
  }
  return true;
}

constexpr std::array<std::uint8_t, 2> kJpegBegin = {0xFF, 0xD8};
constexpr std::array<std::uint8_t, 2> kJpegScan = {0xFF, 0xDA};
constexpr std::array<std::uint8_t, 2> kJpegEnd = {0xFF, 0xD9};

/// JPEG is a row of segments, 2 bytes of marker and 2 of length, up to the coded pixels, which no end marker can be part of
/// (ITU T.81, B.1.1). A thumbnail in a segment before has an end marker of its own.
bool jpegEndsEarly(const Bytes& bytes) {
  constexpr std::size_t kMarkerBytes = 2;
  constexpr std::size_t kLengthBytes = 2;
  std::size_t at = kJpegBegin.size();
  while (!hasAt(bytes, at, kJpegScan)) {
    if (at + kMarkerBytes + kLengthBytes > bytes.size()) {
      return true;
    }
    if (bytes[at] != kJpegBegin[0]) {
      return false;  // no marker where one must be: broken, but not for its length
    }
    const bool is_fill = bytes[at + 1] == kJpegBegin[0];
    at += is_fill ? 1 : kMarkerBytes + numberAt(bytes, at + kMarkerBytes, kLengthBytes);
  }
  const auto scan = bytes.begin() + static_cast<std::ptrdiff_t>(at);
  return std::find_end(scan, bytes.end(), kJpegEnd.begin(), kJpegEnd.end()) == bytes.end();
}

}  // namespace

bool endsEarly(const Bytes& bytes) {
  if (hasAt(bytes, 0, kPngBegin)) {
    return pngEndsEarly(bytes);
  }
  return hasAt(bytes, 0, kJpegBegin) && jpegEndsEarly(bytes);
}

}  // namespace tartan_calib::io
