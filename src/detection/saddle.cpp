#include "tartan_calib/detection/saddle.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <tuple>

#include "hessian.h"
#include "wedges.h"

namespace tartan_calib::detection {
namespace {

constexpr int kMargin_px = 4;          ///< the first ring plus the way of a candidate
constexpr int kMinLevelSide_px = 120;  ///< a smaller level has no board of use
/// A sharp X-junction of right angles has sqrt(-det H) = contrast / kContrastPerResponse per grey level.
constexpr double kContrastPerResponse = 4.3;
constexpr double kSuppressionRadius_px = 1.6;  ///< [level px] of the coarser of two saddles

struct Level {
  cv::Mat gray;
  cv::Mat smoothed;
  double scale_px;  ///< full-resolution pixels per pixel of this level

  Eigen::Vector2d toFullResolution(const Eigen::Vector2d& px) const { return (px.array() + 0.5) * scale_px - 0.5; }
};

/// Newton steps from a peak of the response to the zero of the gradient; nothing where the surface has no saddle near it.
std::optional<Eigen::Vector2d> locateSaddle(const cv::Mat& smoothed, const SaddlePeak& peak) {
  constexpr int kMaxMoves = 3;
  constexpr double kMaxStep_px = 1.5;
  constexpr double kNearestPixel_px = 0.6;
  constexpr double kNextPixel_px = 1.1;
  int x = peak.x;
  int y = peak.y;
  for (int move = 0; move < kMaxMoves; ++move) {
    if (x < 1 || y < 1 || x >= smoothed.cols - 1 || y >= smoothed.rows - 1) {
      return std::nullopt;
    }
    const std::int16_t* above = smoothed.ptr<std::int16_t>(y - 1) + x;
    const std::int16_t* row = smoothed.ptr<std::int16_t>(y) + x;
    const std::int16_t* below = smoothed.ptr<std::int16_t>(y + 1) + x;
    const Eigen::Vector2d gradient(0.5 * (row[1] - row[-1]), 0.5 * (below[0] - above[0]));
    Eigen::Matrix2d hessian;
    hessian(0, 0) = row[1] + row[-1] - 2 * row[0];
    hessian(1, 1) = below[0] + above[0] - 2 * row[0];
    hessian(0, 1) = hessian(1, 0) = 0.25 * (above[-1] + below[1] - above[1] - below[-1]);
    const double det = hessian(0, 0) * hessian(1, 1) - hessian(0, 1) * hessian(0, 1);
    if (det >= 0.0) {
      return std::nullopt;
    }
    const Eigen::Vector2d step(-(hessian(1, 1) * gradient.x() - hessian(0, 1) * gradient.y()) / det,
                               -(hessian(0, 0) * gradient.y() - hessian(0, 1) * gradient.x()) / det);
    const double length_px = step.cwiseAbs().maxCoeff();
    if (length_px > kMaxStep_px) {
      return std::nullopt;
    }
    // Half-way between pixels each of the two may send to the other: the last one is believed.
    if (length_px <= kNearestPixel_px || (move + 1 == kMaxMoves && length_px <= kNextPixel_px)) {
      return Eigen::Vector2d(x, y) + step;
    }
    x += static_cast<int>(std::lround(step.x()));
    y += static_cast<int>(std::lround(step.y()));
  }
  return std::nullopt;
}

/// Keeps the strongest peaks of a level; equal ones by position, so that the result does not depend on the library.
void keepStrongest(std::vector<SaddlePeak>& peaks, std::size_t max_count) {
  if (peaks.size() <= max_count) {
    return;
  }
  const auto stronger = [](const SaddlePeak& a, const SaddlePeak& b) {
    return std::tie(b.response, a.y, a.x) < std::tie(a.response, b.y, b.x);
  };
  std::nth_element(peaks.begin(), peaks.begin() + static_cast<std::ptrdiff_t>(max_count), peaks.end(), stronger);
  peaks.resize(max_count);
}

std::vector<Saddle> findInLevel(const Level& level, const SaddleOptions& options) {
  const double min_response = kSmoothedUnitsPerGrey * 0.5 * options.min_contrast / kContrastPerResponse;
  auto peaks = findSaddlePeaks(level.smoothed, static_cast<std::int32_t>(min_response * min_response), kMargin_px);
  keepStrongest(peaks, level.gray.total() / static_cast<std::size_t>(std::max(1, options.min_px2_per_saddle)));
  std::vector<Saddle> saddles;
  for (const SaddlePeak& peak : peaks) {
    const auto px = locateSaddle(level.smoothed, peak);
    if (!px) {
      continue;
    }
    const auto wedges = findWedges(level.gray, *px);
    if (wedges && wedges->contrast >= options.min_contrast) {
      saddles.push_back({level.toFullResolution(*px), wedges->arm_rad, wedges->contrast, level.scale_px});
    }
  }
  return saddles;
}

std::vector<Level> buildPyramid(const cv::Mat& gray, int num_levels) {
  std::vector<Level> levels;
  cv::Mat image = gray;
  double scale_px = 1.0;
  while (static_cast<int>(levels.size()) < num_levels) {
    levels.push_back({image, smoothBinomial(image), scale_px});
    if (std::min(image.cols, image.rows) / 2 < kMinLevelSide_px) {
      break;
    }
    // An odd last row or column is left out, so that pixels keep their exact places.
    const cv::Mat even = image(cv::Rect(0, 0, image.cols / 2 * 2, image.rows / 2 * 2));
    cv::Mat half;
    cv::resize(even, half, even.size() / 2, 0.0, 0.0, cv::INTER_AREA);
    image = half;
    scale_px *= 2.0;
  }
  return levels;
}

/// A coarser level must show more contrast by 1.4 per level to be preferred, for it is less exact.
double merit(const Saddle& saddle) { return saddle.contrast / std::sqrt(saddle.scale_px); }

/// Of saddles that lie on each other keeps the strongest, the sharper where they are about as strong.
std::vector<Saddle> suppressDuplicates(std::vector<Saddle> saddles, const cv::Size& size) {
  constexpr int kCell_px = 16;  // no smaller than the largest suppression radius
  std::sort(saddles.begin(), saddles.end(), [](const Saddle& a, const Saddle& b) {
    return std::make_tuple(-merit(a), a.scale_px, a.px.y(), a.px.x()) <
           std::make_tuple(-merit(b), b.scale_px, b.px.y(), b.px.x());
  });
  const int cells_x = size.width / kCell_px + 3;
  const int cells_y = size.height / kCell_px + 3;
  std::vector<std::vector<std::size_t>> cells(static_cast<std::size_t>(cells_x * cells_y));
  const auto cell_index = [&](const Eigen::Vector2d& px, int dx, int dy) {
    return static_cast<std::size_t>((static_cast<int>(px.y()) / kCell_px + 1 + dy) * cells_x +
                                    static_cast<int>(px.x()) / kCell_px + 1 + dx);
  };
  std::vector<Saddle> kept;
  const auto is_taken = [&](const Saddle& saddle) {
    for (int neighbour = 0; neighbour < 9; ++neighbour) {
      for (const std::size_t other : cells[cell_index(saddle.px, neighbour % 3 - 1, neighbour / 3 - 1)]) {
        const double radius_px = kSuppressionRadius_px * std::max(kept[other].scale_px, saddle.scale_px);
        if ((kept[other].px - saddle.px).squaredNorm() < radius_px * radius_px) {
          return true;
        }
      }
    }
    return false;
  };
  for (const Saddle& saddle : saddles) {
    if (!is_taken(saddle)) {
      cells[cell_index(saddle.px, 0, 0)].push_back(kept.size());
      kept.push_back(saddle);
    }
  }
  return kept;
}

}  // namespace

std::vector<Saddle> findSaddles(const cv::Mat& gray, const SaddleOptions& options) {
  CV_Assert(gray.type() == CV_8UC1);
  std::vector<Saddle> saddles;
  if (std::min(gray.cols, gray.rows) <= 2 * kMargin_px + 1) {
    return saddles;
  }
  for (const Level& level : buildPyramid(gray, options.num_levels)) {
    const auto found = findInLevel(level, options);
    saddles.insert(saddles.end(), found.begin(), found.end());
  }
  return suppressDuplicates(std::move(saddles), gray.size());
}

}  // namespace tartan_calib::detection
