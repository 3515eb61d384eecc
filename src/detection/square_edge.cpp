#include "square_edge.h"

#include <algorithm>
#include <cmath>

#include "bilinear.h"

namespace tartan_calib::detection {
namespace {

constexpr double kPi = 3.14159265358979323846;
// Between an arm and the chord to the next corner: half the arc that a square spans under strong fisheye bending plus the
// error of the arm's angle.
constexpr double kMaxBend_rad = 0.5;
// A bent edge is as unlikely as a straight one that is longer by this factor per radian.
constexpr double kBendCost_per_rad = 2.0;
// Share of the saddles' contrast that must be found across the edge between them, everywhere along it.
constexpr double kMinContrast_ratio = 0.25;
// Where the edge is crossed, to both sides of it: far enough to get past its blur, within the squares beside it.
constexpr double kCrossing_ratio = 0.12;
constexpr double kMinCrossing_px = 1.0;
constexpr double kMaxCrossing_px = 4.0;

double angleBetween(double a_rad, double b_rad) { return std::abs(std::remainder(a_rad - b_rad, 2.0 * kPi)); }

Eigen::Vector2d direction(double angle_rad) { return {std::cos(angle_rad), std::sin(angle_rad)}; }

/// Cubic curve with given ends and tangents, t in [0, 1] (Hermite form).
struct Curve {
  Eigen::Vector2d start, leave, end, arrive;

  Eigen::Vector2d point(double t) const {
    const double s = 1.0 - t;
    return s * s * ((1.0 + 2.0 * t) * start + t * leave) + t * t * ((1.0 + 2.0 * s) * end - s * arrive);
  }
  Eigen::Vector2d tangent(double t) const {
    const double s = 1.0 - t;
    return 6.0 * s * t * (end - start) + s * (s - 2.0 * t) * leave + t * (t - 2.0 * s) * arrive;
  }
};

bool hasContrast(const cv::Mat& gray, const Eigen::Vector2d& dark, const Eigen::Vector2d& light, double min_contrast) {
  return canSample(gray, dark.x(), dark.y()) && canSample(gray, light.x(), light.y()) &&
         sampleBilinear(gray, light.x(), light.y()) - sampleBilinear(gray, dark.x(), dark.y()) >= min_contrast;
}

}  // namespace

std::optional<double> squareEdgeCost(const cv::Mat& gray, const std::vector<Saddle>& saddles, const ArmLink& from,
                                     const ArmLink& to) {
  const Saddle& p = saddles[static_cast<std::size_t>(from.saddle_index)];
  const Saddle& q = saddles[static_cast<std::size_t>(to.saddle_index)];
  const double leave_rad = p.arm_rad[static_cast<std::size_t>(from.arm)];
  const double return_rad = q.arm_rad[static_cast<std::size_t>(to.arm)];
  const Eigen::Vector2d chord = q.px - p.px;
  const double chord_rad = std::atan2(chord.y(), chord.x());
  const double bend_rad = angleBetween(leave_rad, chord_rad);
  const double end_bend_rad = angleBetween(return_rad, chord_rad + kPi);
  // Dark lies on the other side of the edge as seen from its other end: an even arm meets an odd one.
  if ((from.arm + to.arm) % 2 == 0 || bend_rad > kMaxBend_rad || end_bend_rad > kMaxBend_rad) {
    return std::nullopt;
  }
  const double length_px = chord.norm();
  const Curve edge{p.px, length_px * direction(leave_rad), q.px, -length_px * direction(return_rad)};
  const double dark_side = from.arm % 2 == 0 ? 1.0 : -1.0;
  const double crossing_px = dark_side * std::clamp(kCrossing_ratio * length_px, kMinCrossing_px, kMaxCrossing_px);
  const double min_contrast = kMinContrast_ratio * std::max(p.contrast, q.contrast);
  for (const double t : {0.25, 0.375, 0.5, 0.625, 0.75}) {
    const Eigen::Vector2d along = edge.tangent(t).normalized();
    const Eigen::Vector2d to_dark = crossing_px * Eigen::Vector2d(-along.y(), along.x());
    if (!hasContrast(gray, edge.point(t) + to_dark, edge.point(t) - to_dark, min_contrast)) {
      return std::nullopt;
    }
  }
  return length_px * (1.0 + kBendCost_per_rad * (bend_rad + end_bend_rad));
}

}  // namespace tartan_calib::detection
