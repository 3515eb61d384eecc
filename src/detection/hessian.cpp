#include "hessian.h"

#include <algorithm>
#include <array>
#include <opencv2/imgproc.hpp>

// The loops below are plain integer arithmetic that the compiler vectorises; clones let it use AVX2 where present.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__)
#define TARTAN_CALIB_HOT __attribute__((target_clones("avx2", "default")))
#else
#define TARTAN_CALIB_HOT
#endif

namespace tartan_calib::detection {
namespace {

constexpr int kRadius = 2;  // of the 5-tap binomial 1 4 6 4 1

using Rows = std::array<const std::uint8_t*, 5>;

TARTAN_CALIB_HOT void smoothColumns(const Rows& rows, int width, std::uint16_t* out) {
  const std::uint8_t* r0 = rows[0];
  const std::uint8_t* r1 = rows[1];
  const std::uint8_t* r2 = rows[2];
  const std::uint8_t* r3 = rows[3];
  const std::uint8_t* r4 = rows[4];
  for (int x = 0; x < width; ++x) {
    out[x] = static_cast<std::uint16_t>(r0[x] + r4[x] + 4 * (r1[x] + r3[x]) + 6 * r2[x]);
  }
}

/// `in` has kRadius values before its first and after its last. The sum of weights is 256: >> 3 leaves 1/32 grey levels.
TARTAN_CALIB_HOT void smoothRow(const std::uint16_t* in, int width, std::int16_t* out) {
  for (int x = 0; x < width; ++x) {
    const int sum = in[x - 2] + in[x + 2] + 4 * (in[x - 1] + in[x + 1]) + 6 * in[x];
    out[x] = static_cast<std::int16_t>((sum + 4) >> 3);
  }
}

/// -det(Hessian) of pixels 1 .. width - 2 of the middle row.
TARTAN_CALIB_HOT void responseRow(const std::int16_t* above, const std::int16_t* row, const std::int16_t* below, int width,
                                  std::int32_t* out) {
  for (int x = 1; x < width - 1; ++x) {
    const int twice = 2 * row[x];
    const int xx = row[x - 1] + row[x + 1] - twice;
    const int yy = above[x] + below[x] - twice;
    const int xy4 = above[x - 1] + below[x + 1] - above[x + 1] - below[x - 1];
    out[x] = ((xy4 * xy4) >> 4) - xx * yy;
  }
}

bool isPeak(const std::array<const std::int32_t*, 3>& rows, int x) {
  const std::int32_t value = rows[1][x];
  for (int dx = -1; dx <= 1; ++dx) {
    if (rows[0][x + dx] >= value || rows[2][x + dx] > value) {
      return false;
    }
  }
  return rows[1][x - 1] < value && rows[1][x + 1] <= value;
}

}  // namespace

cv::Mat smoothBinomial(const cv::Mat& gray) {
  cv::Mat smoothed(gray.size(), CV_16SC1);
  const int width = gray.cols;
  std::vector<std::uint16_t> padded(static_cast<std::size_t>(width + 2 * kRadius));
  std::uint16_t* line = padded.data() + kRadius;
  for (int y = 0; y < gray.rows; ++y) {
    Rows rows{};
    for (int k = 0; k < 5; ++k) {
      rows[static_cast<std::size_t>(k)] = gray.ptr(std::clamp(y + k - kRadius, 0, gray.rows - 1));
    }
    smoothColumns(rows, width, line);
    std::fill_n(line - kRadius, kRadius, line[0]);
    std::fill_n(line + width, kRadius, line[width - 1]);
    smoothRow(line, width, smoothed.ptr<std::int16_t>(y));
  }
  return smoothed;
}

std::vector<SaddlePeak> findSaddlePeaks(const cv::Mat& smoothed, std::int32_t min_response, int margin_px) {
  const int width = smoothed.cols;
  const int height = smoothed.rows;
  const int margin = std::max(margin_px, 2);
  std::vector<SaddlePeak> peaks;
  cv::Mat ring(3, width, CV_32SC1, cv::Scalar(0));  // responses of the rows y - 1, y, y + 1, each in slot (row % 3)
  for (int next = 1; next < height - 1; ++next) {
    responseRow(smoothed.ptr<std::int16_t>(next - 1), smoothed.ptr<std::int16_t>(next), smoothed.ptr<std::int16_t>(next + 1),
                width, ring.ptr<std::int32_t>(next % 3));
    const int y = next - 1;
    if (y < margin || y >= height - margin) {
      continue;
    }
    const std::array<const std::int32_t*, 3> rows = {ring.ptr<std::int32_t>((y - 1) % 3), ring.ptr<std::int32_t>(y % 3),
                                                     ring.ptr<std::int32_t>(next % 3)};
    for (int x = margin; x < width - margin; ++x) {
      if (rows[1][x] > min_response && isPeak(rows, x)) {
        peaks.push_back({rows[1][x], x, y});
      }
    }
  }
  return peaks;
}

}  // namespace tartan_calib::detection
