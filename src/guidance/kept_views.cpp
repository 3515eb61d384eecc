#include "tartan_calib/guidance/kept_views.h"

#include <algorithm>
#include <numeric>
#include <opencv2/imgcodecs.hpp>

#include "tartan_calib/median.h"

namespace tartan_calib::guidance {
namespace {

std::optional<double> medianShift(const observation::CameraView& a, const observation::CameraView& b) {
  std::vector<double> shifts_px;
  auto other = b.corners.begin();
  for (const observation::Corner& corner : a.corners) {  // both by increasing id
    while (other != b.corners.end() && other->corner_id < corner.corner_id) {
      ++other;
    }
    if (other != b.corners.end() && other->corner_id == corner.corner_id) {
      shifts_px.push_back((other->px - corner.px).norm());
    }
  }
  if (shifts_px.empty()) {
    return std::nullopt;
  }
  return upperMedian(shifts_px);
}

}  // namespace

cv::Mat EncodedImage::decode() const { return cv::imdecode(png, cv::IMREAD_GRAYSCALE); }

EncodedImage encodeImage(int camera_index, std::int64_t stamp_ns, const cv::Mat& gray) {
  EncodedImage image{camera_index, stamp_ns, {}};
  cv::imencode(".png", gray, image.png, {cv::IMWRITE_PNG_COMPRESSION, 1});  // the fastest
  return image;
}

std::size_t encodedBytes(const KeptView& kept) {
  return std::accumulate(kept.images.begin(), kept.images.end(), std::size_t{0},
                         [](std::size_t sum, const EncodedImage& image) { return sum + image.png.size(); });
}

double viewChange(const observation::View& a, const observation::View& b, const std::vector<double>& diagonals_px) {
  std::optional<double> largest;
  for (const observation::CameraView& image : a.cameras) {
    for (const observation::CameraView& other : b.cameras) {
      const auto shift_px = image.camera_index == other.camera_index ? medianShift(image, other) : std::nullopt;
      if (shift_px) {
        largest = std::max(largest.value_or(0.0), *shift_px / diagonals_px[static_cast<std::size_t>(image.camera_index)]);
      }
    }
  }
  return largest.value_or(1.0);
}

}  // namespace tartan_calib::guidance
