#include "quad_finder.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <opencv2/imgproc.hpp>
#include <optional>

namespace tartan_calib::detection {
namespace {

/// Sides of the windows against whose means a pixel is dark, from less than the smallest tags to more than the largest.
constexpr std::array<int, 4> kWindows_px = {15, 31, 63, 127};
constexpr double kDarkerGrey = 6.0;
/// Bridges at the corners are cut by taking this away from every dark area.
constexpr int kErosion_px = 1;
/// From the centres of the outermost pixels that are left to the edge.
constexpr double kEdge_px = kErosion_px + 0.5;
constexpr double kMinSide_px = 5.0;
/// Deviation of the outline from four straight sides, as a part of its length and at least.
constexpr double kMaxDeviationRatio = 0.02;
constexpr double kMinDeviation_px = 1.5;
/// Ends of a side that its line does not need: corners are round.
constexpr double kRoundedPart = 0.1;

using Outline = std::vector<cv::Point>;
using Line = Eigen::Hyperplane<double, 2>;

/// The line through the points of a side, moved out to the edge.
std::optional<Line> sideLine(const Outline& outline, std::size_t begin, std::size_t end, const Eigen::Vector2d& inside) {
  const std::size_t size = (end + outline.size() - begin) % outline.size() + 1;
  const auto skipped = static_cast<std::size_t>(kRoundedPart * static_cast<double>(size));
  std::vector<cv::Point> points;
  for (std::size_t i = skipped; i + skipped < size; ++i) {
    points.push_back(outline[(begin + i) % outline.size()]);
  }
  if (points.size() < 2) {
    return std::nullopt;
  }
  cv::Vec4f fitted;
  cv::fitLine(points, fitted, cv::DIST_L2, 0.0, 0.01, 0.01);
  const Eigen::Vector2d along(static_cast<double>(fitted[0]), static_cast<double>(fitted[1]));
  const Eigen::Vector2d on_line(static_cast<double>(fitted[2]), static_cast<double>(fitted[3]));
  Eigen::Vector2d outward(-along.y(), along.x());
  outward *= outward.dot(inside - on_line) > 0.0 ? -1.0 : 1.0;
  return Line(outward, on_line + kEdge_px * outward);
}

/// Where in the outline its vertices are.
std::optional<std::array<std::size_t, 4>> vertices(const Outline& outline) {
  const double tolerance_px = std::max(kMinDeviation_px, kMaxDeviationRatio * cv::arcLength(outline, true));
  Outline polygon;
  cv::approxPolyDP(outline, polygon, tolerance_px, true);
  if (polygon.size() != 4 || !cv::isContourConvex(polygon)) {
    return std::nullopt;
  }
  std::array<std::size_t, 4> indices{};
  for (std::size_t i = 0; i < 4; ++i) {
    if (cv::norm(polygon[(i + 1) % 4] - polygon[i]) + 2.0 * kEdge_px < kMinSide_px) {
      return std::nullopt;
    }
    indices[i] = static_cast<std::size_t>(std::find(outline.begin(), outline.end(), polygon[i]) - outline.begin());
  }
  return indices;
}

std::optional<Quad> quadOf(const Outline& outline) {
  auto corners = vertices(outline);
  if (!corners) {
    return std::nullopt;
  }
  Eigen::Vector2d inside = Eigen::Vector2d::Zero();
  for (const std::size_t i : *corners) {
    inside += 0.25 * Eigen::Vector2d(outline[i].x, outline[i].y);
  }
  // approxPolyDP keeps the order of the outline, but may begin anywhere.
  std::array<std::optional<Line>, 4> sides;
  for (std::size_t i = 0; i < 4; ++i) {
    sides[i] = sideLine(outline, (*corners)[i], (*corners)[(i + 1) % 4], inside);
    if (!sides[i]) {
      return std::nullopt;
    }
  }
  Quad quad;
  for (std::size_t i = 0; i < 4; ++i) {
    quad[i] = sides[(i + 3) % 4]->intersection(*sides[i]);
    const Eigen::Vector2d vertex((outline[(*corners)[i]]).x, outline[(*corners)[i]].y);
    if (!quad[i].allFinite() || (quad[i] - vertex).norm() > kMinSide_px) {
      return std::nullopt;
    }
  }
  return quad;
}

}  // namespace

std::vector<Quad> findQuads(const cv::Mat& gray) {
  std::vector<Quad> quads;
  const cv::Mat kernel = cv::getStructuringElement(cv::MORPH_RECT, cv::Size(2 * kErosion_px + 1, 2 * kErosion_px + 1));
  for (const int window_px : kWindows_px) {
    cv::Mat dark;
    cv::adaptiveThreshold(gray, dark, 255.0, cv::ADAPTIVE_THRESH_MEAN_C, cv::THRESH_BINARY_INV, window_px, kDarkerGrey);
    cv::erode(dark, dark, kernel);
    std::vector<Outline> outlines;
    cv::findContours(dark, outlines, cv::RETR_LIST, cv::CHAIN_APPROX_NONE);
    for (const Outline& outline : outlines) {
      if (const auto quad = quadOf(outline)) {
        quads.push_back(*quad);
      }
    }
  }
  return quads;
}

}  // namespace tartan_calib::detection
