#include "wedges.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "bilinear.h"

namespace tartan_calib::detection {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr int kRingSamples = 32;
/// Rings around a candidate [level px]: the first must show the four wedges, wider ones only make the arms' angles better.
constexpr std::array<double, 3> kRingRadii_px = {2.5, 4.0, 6.0};
constexpr double kMaxArmBend_rad = 0.6;          ///< between opposite arms of a narrow ring, noise and lens together
constexpr double kMaxArmDisagreement_rad = 0.3;  ///< between a ring and the next wider one
constexpr double kMinWedge_rad = 0.25;           ///< narrower wedges are lines
constexpr double kMaxWedgeImbalance = 0.6;       ///< between wedges of one shade, in units of the contrast

using Ring = std::array<float, kRingSamples>;

double wrapped(double angle_rad) { return std::remainder(angle_rad, 2.0 * kPi); }

/// Ring of grey values, low-passed by 1 2 1 along the ring.
Ring sampleRing(const cv::Mat& gray, const Eigen::Vector2d& px, double radius_px) {
  static const std::array<Eigen::Vector2d, kRingSamples> directions = [] {
    std::array<Eigen::Vector2d, kRingSamples> unit;
    for (int k = 0; k < kRingSamples; ++k) {
      const double angle_rad = 2.0 * kPi * k / kRingSamples;
      unit[static_cast<std::size_t>(k)] = {std::cos(angle_rad), std::sin(angle_rad)};
    }
    return unit;
  }();
  Ring raw{};
  for (std::size_t k = 0; k < kRingSamples; ++k) {
    raw[k] = sampleBilinear(gray, px.x() + radius_px * directions[k].x(), px.y() + radius_px * directions[k].y());
  }
  Ring smooth{};
  for (std::size_t k = 0; k < kRingSamples; ++k) {
    smooth[k] = 0.25F * (raw[(k + kRingSamples - 1) % kRingSamples] + 2.0F * raw[k] + raw[(k + 1) % kRingSamples]);
  }
  return smooth;
}

/// Grey value half-way between the dark and the light part of the ring.
float midGray(const Ring& ring) {
  const float sum = std::accumulate(ring.begin(), ring.end(), 0.0F);
  const float mean = sum / kRingSamples;
  float light = 0.0F;
  float num_light = 0.0F;
  for (const float value : ring) {
    light += value > mean ? value : 0.0F;
    num_light += value > mean ? 1.0F : 0.0F;
  }
  const float num_dark = kRingSamples - num_light;
  return num_light == 0.0F || num_dark == 0.0F ? mean : 0.5F * (light / num_light + (sum - light) / num_dark);
}

/// Angles where the ring crosses `mid`, the first from light to dark; nothing unless there are four.
std::optional<std::array<double, 4>> crossings(const Ring& ring, float mid) {
  std::array<double, 4> angles{};
  std::size_t count = 0;
  bool first_darkens = false;
  for (std::size_t k = 0; k < kRingSamples; ++k) {
    const float here = ring[k] - mid;
    const float next = ring[(k + 1) % kRingSamples] - mid;
    if ((here > 0.0F) == (next > 0.0F)) {
      continue;
    }
    if (count == 4) {
      return std::nullopt;
    }
    first_darkens = count == 0 ? here > 0.0F : first_darkens;
    angles[count++] = (static_cast<double>(k) + static_cast<double>(here / (here - next))) * 2.0 * kPi / kRingSamples;
  }
  if (count != 4) {
    return std::nullopt;
  }
  if (!first_darkens) {
    std::rotate(angles.begin(), angles.begin() + 1, angles.end());
    angles[3] += 2.0 * kPi;
  }
  return angles;
}

/// Extreme grey value, relative to `mid`, of the wedge between two angles.
double wedgePeak(const Ring& ring, float mid, double from_rad, double to_rad) {
  const auto index = [](double angle_rad) { return angle_rad * kRingSamples / (2.0 * kPi); };
  float peak = 0.0F;
  for (int k = static_cast<int>(std::ceil(index(from_rad))); k <= static_cast<int>(index(to_rad)); ++k) {
    peak = std::max(peak, std::abs(ring[static_cast<std::size_t>(k) % kRingSamples] - mid));
  }
  return static_cast<double>(peak);
}

/// The four wedges of a ring, if it has two dark and two light ones, opposite each other and alike.
std::optional<Wedges> wedgesOf(const Ring& ring) {
  const float mid = midGray(ring);
  const auto arms = crossings(ring, mid);
  if (!arms) {
    return std::nullopt;
  }
  const auto& a = *arms;
  if (std::abs(a[2] - a[0] - kPi) > kMaxArmBend_rad || std::abs(a[3] - a[1] - kPi) > kMaxArmBend_rad) {
    return std::nullopt;
  }
  std::array<double, 4> peaks{};
  for (std::size_t k = 0; k < 4; ++k) {
    const double end_rad = k < 3 ? a[k + 1] : a[0] + 2.0 * kPi;
    if (end_rad - a[k] < kMinWedge_rad) {
      return std::nullopt;
    }
    peaks[k] = wedgePeak(ring, mid, a[k], end_rad);
  }
  const double contrast = 0.5 * (peaks[0] + peaks[1] + peaks[2] + peaks[3]);
  const double imbalance = std::max(std::abs(peaks[0] - peaks[2]), std::abs(peaks[1] - peaks[3]));
  if (imbalance > kMaxWedgeImbalance * contrast) {
    return std::nullopt;
  }
  return Wedges{a, contrast};
}

bool agree(const Wedges& narrow, const Wedges& wide) {
  for (std::size_t k = 0; k < 4; ++k) {
    if (std::abs(wrapped(narrow.arm_rad[k] - wide.arm_rad[k])) > kMaxArmDisagreement_rad) {
      return false;
    }
  }
  return true;
}

/// A wide ring may start at the opposite arm; this gives it the narrow ring's order.
Wedges sameOrder(const Wedges& narrow, Wedges wide) {
  if (std::abs(wrapped(narrow.arm_rad[0] - wide.arm_rad[0])) > 0.5 * kPi) {
    std::rotate(wide.arm_rad.begin(), wide.arm_rad.begin() + 2, wide.arm_rad.end());
    wide.arm_rad[2] += 2.0 * kPi;
    wide.arm_rad[3] += 2.0 * kPi;
  }
  return wide;
}

}  // namespace

std::optional<Wedges> findWedges(const cv::Mat& gray, const Eigen::Vector2d& px) {
  std::optional<Wedges> wedges;
  for (const double radius_px : kRingRadii_px) {
    const double reach_px = radius_px + 1.0;
    if (!canSample(gray, px.x() - reach_px, px.y() - reach_px) || !canSample(gray, px.x() + reach_px, px.y() + reach_px)) {
      break;
    }
    auto wider = wedgesOf(sampleRing(gray, px, radius_px));
    if (!wider) {
      break;
    }
    if (wedges) {
      wider = sameOrder(*wedges, *wider);
      if (!agree(*wedges, *wider)) {
        break;
      }
    }
    wedges = wider;
  }
  return wedges;
}

}  // namespace tartan_calib::detection
