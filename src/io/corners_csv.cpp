#include "tartan_calib/io/corners_csv.h"

#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>

#include "corners_header.h"
#include "tartan_calib/error.h"

namespace tartan_calib::io {
namespace {

using observation::CameraView;
using observation::Corner;

/// Text of one row, built without allocation.
class Row {
 public:
  void clear() { size_ = 0; }
  std::string_view text() const { return {buffer_.data(), size_}; }

  void add(char c) { buffer_[size_++] = c; }

  void add(std::int64_t value) {
    size_ = static_cast<std::size_t>(std::to_chars(begin(), end(), value).ptr - buffer_.data());
  }

  /// Six decimals. Pixels are far within the range where value * 1e6 is exact to the last digit of a long.
  void addPixel(double value) {
    constexpr std::int64_t kScale = 1'000'000;
    const std::int64_t scaled = std::llround(std::abs(value) * kScale);
    if (std::signbit(value) && scaled != 0) {
      add('-');
    }
    add(scaled / kScale);
    add('.');
    std::int64_t rest = scaled % kScale;
    for (std::int64_t unit = kScale / 10; unit > 0; unit /= 10) {
      add(static_cast<char>('0' + rest / unit));
      rest %= unit;
    }
  }

  void addCovariance(double value) {
    if (value == 0.0 || value == 1.0) {  // what a detector without covariances gives
      add(value == 0.0 ? '0' : '1');
      return;
    }
    size_ += static_cast<std::size_t>(std::snprintf(begin(), static_cast<std::size_t>(end() - begin()), "%.9g", value));
  }

 private:
  char* begin() { return buffer_.data() + size_; }
  char* end() { return buffer_.data() + buffer_.size(); }

  std::array<char, 256> buffer_{};
  std::size_t size_ = 0;
};

void fillRow(Row& row, int camera_index, const CameraView& image, const Corner& corner) {
  row.clear();
  row.add(static_cast<std::int64_t>(camera_index));
  row.add(',');
  row.add(image.stamp_ns);
  row.add(',');
  row.add(static_cast<std::int64_t>(corner.corner_id));
  for (const double value : {corner.px.x(), corner.px.y()}) {
    row.add(',');
    row.addPixel(value);
  }
  for (const double value : {corner.cov_px2(0, 0), corner.cov_px2(0, 1), corner.cov_px2(1, 1)}) {
    row.add(',');
    row.addCovariance(value);
  }
  row.add(',');
  row.add(corner.used ? '1' : '0');
  row.add('\n');
}

bool isWritable(const Corner& corner) {
  constexpr double kMaxPixel = 1e9;
  return corner.px.allFinite() && corner.px.cwiseAbs().maxCoeff() < kMaxPixel && corner.cov_px2.allFinite();
}

}  // namespace

void writeCorners(const std::vector<pipeline::CameraCorners>& cameras, AtomicFile& file) {
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    file.write(cameraLine({static_cast<int>(i), cameras[i].width, cameras[i].height, cameras[i].topic}) + "\n");
  }
  file.write(std::string(kCornersHeader) + "\n");
  Row row;
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    for (const CameraView& image : cameras[i].images) {
      for (const Corner& corner : image.corners) {
        if (!isWritable(corner)) {
          throw Error("corner " + std::to_string(corner.corner_id) + " of cam" + std::to_string(i) +
                      " has no finite position");
        }
        fillRow(row, static_cast<int>(i), image, corner);
        file.write(row.text());
      }
    }
  }
}

void saveCorners(const std::string& path, const std::vector<pipeline::CameraCorners>& cameras) {
  AtomicFile file(path);
  writeCorners(cameras, file);
  file.commit();
}

}  // namespace tartan_calib::io
