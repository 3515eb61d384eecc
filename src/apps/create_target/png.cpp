#include <array>
#include <boost/crc.hpp>
#include <cmath>
#include <cstdint>
#include <opencv2/imgcodecs.hpp>
#include <vector>

#include "create_target/drawing.h"

namespace tartan_calib::apps {
namespace {

/// Where the chunks after the header begin: signature, and length, name, 13 bytes and checksum of IHDR.
constexpr std::size_t kAfterHeader = 8 + 4 + 4 + 13 + 4;

void appendBigEndian(std::uint32_t value, std::string& bytes) {
  for (const unsigned shift : {24U, 16U, 8U, 0U}) {
    bytes += static_cast<char>((value >> shift) & 0xFFU);
  }
}

/// PNG specification 11.3.5.3, physical pixel dimensions.
std::string scaleChunk(double pixels_per_mm) {
  constexpr double kMmPerM = 1e3;
  constexpr char kUnitIsMetre = 1;
  const auto pixels_per_m = static_cast<std::uint32_t>(std::lround(kMmPerM * pixels_per_mm));
  std::string content = "pHYs";
  appendBigEndian(pixels_per_m, content);  // across
  appendBigEndian(pixels_per_m, content);  // down
  content += kUnitIsMetre;
  boost::crc_32_type checksum;
  checksum.process_bytes(content.data(), content.size());
  std::string chunk;
  appendBigEndian(static_cast<std::uint32_t>(content.size() - 4), chunk);  // without its name
  chunk += content;
  appendBigEndian(checksum.checksum(), chunk);
  return chunk;
}

}  // namespace

std::string pngOf(const cv::Mat& gray, double pixels_per_mm) {
  std::vector<std::uint8_t> bytes;
  cv::imencode(".png", gray, bytes);
  std::string png(bytes.begin(), bytes.end());
  png.insert(kAfterHeader, scaleChunk(pixels_per_mm));
  return png;
}

}  // namespace tartan_calib::apps
