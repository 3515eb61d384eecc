#include "inspect_bag/image_quality.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "tartan_calib/median.h"

namespace tartan_calib::apps {
namespace {

constexpr int kLevels = 256;
constexpr int kSaturatedLevel = 250;
constexpr int kBlackLevel = 5;
constexpr double kBright_ratio = 0.99;

/// Slope [grey / px] that noise does not reach.
constexpr double kMinSlope = 8.0;
constexpr double kMinContrast = 40.0;
/// Profiles across an edge reach so far to both sides: the widest edge that is measured is twice that.
constexpr int kReach_px = 12;
/// Edges whose direction is so near to one of the two main ones belong to it: cos 22.5 degrees.
constexpr double kMinCosine = 0.92387953251128674;
constexpr std::size_t kMinEdgePixels = 30;
/// More of one direction do not change the median.
constexpr std::size_t kMaxEdgePixels = 2000;

struct EdgePixel {
  cv::Point at;
  cv::Vec2d slope;  ///< grey / px
};

double steepness(const EdgePixel& pixel) { return cv::norm(pixel.slope); }

/// Slopes of an image.
class Slopes {
 public:
  explicit Slopes(const cv::Mat& gray) {
    cv::Sobel(gray, dx_, CV_16S, 1, 0, 1);
    cv::Sobel(gray, dy_, CV_16S, 0, 1, 1);
  }

  cv::Vec2d at(int row, int col) const {
    constexpr double kHalf = 0.5;  // the central difference spans two pixels
    return {kHalf * dx_(row, col), kHalf * dy_(row, col)};
  }

  /// No pixel up to two farther along the slope is steeper.
  bool isSteepest(int row, int col) const {
    const cv::Vec2d slope = at(row, col);
    const double squared = slope.dot(slope);
    for (const int step : {-2, -1, 1, 2}) {
      const cv::Point beside = alongSlope({col, row}, slope, step);
      const cv::Vec2d other = at(beside.y, beside.x);
      if (other.dot(other) > squared) {
        return false;
      }
    }
    return true;
  }

  static cv::Point alongSlope(const cv::Point& from, const cv::Vec2d& slope, int step_px) {
    const cv::Vec2d direction = slope / cv::norm(slope);
    return {from.x + static_cast<int>(std::lround(step_px * direction[0])),
            from.y + static_cast<int>(std::lround(step_px * direction[1]))};
  }

 private:
  cv::Mat1s dx_;
  cv::Mat1s dy_;
};

std::vector<EdgePixel> edgePixels(const cv::Mat& gray) {
  const Slopes slopes(gray);
  std::vector<EdgePixel> pixels;
  for (int row = kReach_px; row < gray.rows - kReach_px; ++row) {
    for (int col = kReach_px; col < gray.cols - kReach_px; ++col) {
      const cv::Vec2d slope = slopes.at(row, col);
      if (slope.dot(slope) > kMinSlope * kMinSlope && slopes.isSteepest(row, col)) {
        pixels.push_back({{col, row}, slope});
      }
    }
  }
  return pixels;
}

/// Direction that most edges have, up to quarter turns, which a board's edges are apart.
cv::Vec2d mainDirection(const std::vector<EdgePixel>& pixels) {
  std::complex<double> sum;
  for (const EdgePixel& pixel : pixels) {
    const std::complex<double> slope(pixel.slope[0], pixel.slope[1]);
    const std::complex<double> squared = slope * slope;
    sum += squared * squared / std::norm(slope);
  }
  constexpr double kQuarter = 0.25;
  const double angle_rad = kQuarter * std::arg(sum);
  return {std::cos(angle_rad), std::sin(angle_rad)};
}

/// Contrast over slope, along the direction of steepest ascent; 0 where the contrast is that of noise.
double widthAt(const cv::Mat& gray, const EdgePixel& pixel) {
  int low = kLevels;
  int high = 0;
  for (int step = -kReach_px; step <= kReach_px; ++step) {
    const int level = gray.at<std::uint8_t>(Slopes::alongSlope(pixel.at, pixel.slope, step));
    low = std::min(low, level);
    high = std::max(high, level);
  }
  return high - low < kMinContrast ? 0.0 : (high - low) / steepness(pixel);
}

/// Median over the edges across `direction`.
std::optional<double> edgeWidth(const cv::Mat& gray, const std::vector<EdgePixel>& pixels, const cv::Vec2d& direction) {
  std::vector<EdgePixel> across;
  std::copy_if(pixels.begin(), pixels.end(), std::back_inserter(across),
               [&](const EdgePixel& pixel) { return std::abs(pixel.slope.dot(direction)) > kMinCosine * steepness(pixel); });
  std::vector<double> widths_px;
  const std::size_t stride = across.size() / kMaxEdgePixels + 1;
  for (std::size_t i = 0; i < across.size(); i += stride) {
    const double width_px = widthAt(gray, across[i]);
    if (width_px > 0.0) {
      widths_px.push_back(width_px);
    }
  }
  return widths_px.size() < kMinEdgePixels ? std::nullopt : std::make_optional(upperMedian(widths_px));
}

void addLevels(const cv::Mat& gray, ImageQuality& quality) {
  std::array<std::size_t, kLevels> counts{};
  for (int row = 0; row < gray.rows; ++row) {
    for (int col = 0; col < gray.cols; ++col) {
      ++counts[gray.at<std::uint8_t>(row, col)];
    }
  }
  const auto total = static_cast<double>(gray.total());
  double below = 0.0;
  for (int level = 0; level < kLevels; ++level) {
    const double ratio = static_cast<double>(counts[static_cast<std::size_t>(level)]) / total;
    quality.mean_level += ratio * level;
    quality.saturated_ratio += level >= kSaturatedLevel ? ratio : 0.0;
    quality.black_ratio += level <= kBlackLevel ? ratio : 0.0;
    quality.bright_level = below < kBright_ratio ? level : quality.bright_level;
    below += ratio;
  }
}

}  // namespace

ImageQuality qualityOf(const cv::Mat& gray) {
  ImageQuality quality;
  addLevels(gray, quality);
  const std::vector<EdgePixel> pixels = edgePixels(gray);
  const cv::Vec2d direction = mainDirection(pixels);
  for (const cv::Vec2d& across : {direction, cv::Vec2d(-direction[1], direction[0])}) {
    if (const std::optional<double> width_px = edgeWidth(gray, pixels, across)) {
      quality.edge_width_px = std::max(quality.edge_width_px.value_or(0.0), *width_px);
    }
  }
  return quality;
}

}  // namespace tartan_calib::apps
