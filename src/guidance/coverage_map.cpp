#include "tartan_calib/guidance/coverage_map.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace tartan_calib::guidance {
namespace {

/// Cells whose mean never rose above this are outside of the lens's circle: above the noise of a dark sensor, below the
/// darkest corner of a room.
constexpr int kDarkGrey = 12;

constexpr double kMinLit_ratio = 0.3;    ///< of a region's cells, for a region that counts
constexpr double kMinEmpty_ratio = 0.5;  ///< of its lit cells, for one that needs corners

}  // namespace

CoverageMap::CoverageMap(int width, int height)
    : width_(width),
      height_(height),
      counts_(std::max(1, static_cast<int>(std::lround(static_cast<double>(kCols) * height / width))), kCols, 0),
      brightest_(counts_.size(), 0) {}

void CoverageMap::addImage(const cv::Mat& gray) {
  cv::Mat means;
  cv::resize(gray, means, brightest_.size(), 0.0, 0.0, cv::INTER_AREA);
  cv::max(means, brightest_, brightest_);
}

void CoverageMap::addCorners(const std::vector<observation::Corner>& corners) {
  for (const observation::Corner& corner : corners) {
    const int col = static_cast<int>((corner.px.x() + 0.5) * counts_.cols / width_);
    const int row = static_cast<int>((corner.px.y() + 0.5) * counts_.rows / height_);
    ++counts_(std::clamp(row, 0, counts_.rows - 1), std::clamp(col, 0, counts_.cols - 1));
  }
}

bool CoverageMap::isLit(int row, int col) const { return brightest_(row, col) >= kDarkGrey; }

bool CoverageMap::isLit(const Eigen::Vector2d& px) const {
  const double col = std::floor((px.x() + 0.5) * counts_.cols / width_);
  const double row = std::floor((px.y() + 0.5) * counts_.rows / height_);
  return col >= 0.0 && row >= 0.0 && col < counts_.cols && row < counts_.rows &&
         isLit(static_cast<int>(row), static_cast<int>(col));
}

std::vector<Region> CoverageMap::regionsWith(double min_empty_ratio) const {
  std::array<std::array<int, 3>, 9> counts{};  // of cells, lit ones, lit ones without a corner
  for (int row = 0; row < counts_.rows; ++row) {
    for (int col = 0; col < counts_.cols; ++col) {
      auto& [all, lit, empty] = counts.at(static_cast<std::size_t>(row * 3 / counts_.rows * 3 + col * 3 / counts_.cols));
      ++all;
      lit += isLit(row, col) ? 1 : 0;
      empty += isLit(row, col) && counts_(row, col) == 0 ? 1 : 0;
    }
  }
  std::vector<Region> regions;
  for (int i = 0; i < static_cast<int>(counts.size()); ++i) {
    const auto& [all, lit, empty] = counts.at(static_cast<std::size_t>(i));
    if (lit > 0 && lit >= kMinLit_ratio * all && empty >= min_empty_ratio * lit) {
      regions.push_back({i % kRegionsPerSide, i / kRegionsPerSide});
    }
  }
  return regions;
}

std::vector<Region> CoverageMap::litRegions() const { return regionsWith(0.0); }

std::vector<Region> CoverageMap::emptyRegions() const { return regionsWith(kMinEmpty_ratio); }

}  // namespace tartan_calib::guidance
