#include "tartan_calib/simulation/coverage.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace tartan_calib::simulation {
namespace {

/// Counter-clockwise on the screen, where v grows downwards.
void addPolygon(CoverageBuffer& buffer, const std::vector<Eigen::Vector2d>& vertices) {
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    buffer.addEdge(vertices[i], vertices[(i + 1) % vertices.size()], 1.0);
  }
}

std::vector<Eigen::Vector2d> rectangle(double left, double top, double right, double bottom) {
  return {{left, top}, {left, bottom}, {right, bottom}, {right, top}};
}

/// A disc as a polygon of 720 sides; the area of the polygon is known.
std::vector<Eigen::Vector2d> disc(const Eigen::Vector2d& centre, double radius) {
  std::vector<Eigen::Vector2d> vertices;
  for (int i = 0; i < 720; ++i) {
    const double angle = -2.0 * M_PI * i / 720;
    vertices.emplace_back(centre + radius * Eigen::Vector2d(std::cos(angle), std::sin(angle)));
  }
  return vertices;
}

double discArea(double radius) { return 360.0 * radius * radius * std::sin(2.0 * M_PI / 720); }

TEST(CoverageBuffer, givesThePartOfEachPixelThatARectangleCovers) {
  CoverageBuffer buffer(cv::Rect(0, 0, 6, 5));
  addPolygon(buffer, rectangle(0.75, 0.9, 3.2, 2.6));  // pixel 1 spans 0.5 to 1.5
  const cv::Mat1f covered = buffer.coverage();
  const double across[] = {0.0, 0.75, 1.0, 0.7, 0.0, 0.0};
  const double down[] = {0.0, 0.6, 1.0, 0.1, 0.0};
  for (int row = 0; row < 5; ++row) {
    for (int col = 0; col < 6; ++col) {
      EXPECT_NEAR(covered(row, col), across[col] * down[row], 1e-6) << row << " " << col;
    }
  }
}

TEST(CoverageBuffer, sumsToTheAreaOfASlantedShape) {
  CoverageBuffer buffer(cv::Rect(0, 0, 40, 40));
  addPolygon(buffer, disc({19.3, 20.7}, 13.4));
  EXPECT_NEAR(cv::sum(buffer.coverage())[0], discArea(13.4), 1e-3);
}

TEST(CoverageBuffer, isTheSameThroughAnyWindow) {
  CoverageBuffer whole(cv::Rect(0, 0, 40, 40));
  addPolygon(whole, disc({19.3, 20.7}, 13.4));
  const cv::Rect window(11, 9, 15, 17);  // cuts the shape on all four sides
  CoverageBuffer part(window);
  addPolygon(part, disc({19.3, 20.7}, 13.4));
  EXPECT_LT(cv::norm(whole.coverage()(window), part.coverage(), cv::NORM_INF), 1e-6);
}

TEST(CoverageBuffer, subtractsAClockwiseHole) {
  CoverageBuffer buffer(cv::Rect(0, 0, 40, 40));
  addPolygon(buffer, rectangle(4.0, 4.0, 36.0, 36.0));
  std::vector<Eigen::Vector2d> hole = disc({20.0, 20.0}, 6.0);
  addPolygon(buffer, {hole.rbegin(), hole.rend()});
  EXPECT_NEAR(cv::sum(buffer.coverage())[0], 32.0 * 32.0 - discArea(6.0), 1e-3);
  EXPECT_NEAR(buffer.coverage()(20, 20), 0.0, 1e-6);
}

TEST(CoverageBuffer, knowsHowAShiftChangesEachPixel) {
  constexpr double kShiftPx = 1e-2;
  const cv::Rect window(5, 6, 30, 30);  // cuts the shape
  const auto covered = [&window](const Eigen::Vector2d& shift) {
    CoverageBuffer buffer(window);
    addPolygon(buffer, disc(Eigen::Vector2d(19.3, 20.7) + shift, 13.4));
    return buffer.coverage();
  };
  CoverageBuffer buffer(window);
  addPolygon(buffer, disc({19.3, 20.7}, 13.4));
  for (int axis = 0; axis < 2; ++axis) {
    const Eigen::Vector2d shift = kShiftPx * Eigen::Vector2d::Unit(axis);
    const cv::Mat numeric = (covered(shift) - covered(-shift)) / (2.0 * kShiftPx);
    cv::Mat analytic;
    cv::extractChannel(buffer.shiftDerivative(), analytic, axis);
    // An edge that enters a pixel within the shift bends the numeric difference.
    EXPECT_LT(cv::norm(numeric, analytic, cv::NORM_INF), 0.02);
    EXPECT_LT(cv::norm(numeric, analytic, cv::NORM_L1) / window.area(), 2e-4);
  }
}

}  // namespace
}  // namespace tartan_calib::simulation
