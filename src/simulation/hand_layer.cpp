#include "hand_layer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "tartan_calib/simulation/coverage.h"

namespace tartan_calib::simulation {
namespace {

/// A limb of changing thickness: the convex hull of two balls.
struct Limb {
  Eigen::Vector3d from_m;
  Eigen::Vector3d to_m;
  double from_radius_m;
  double to_radius_m;
  double brightness = 1.0;  ///< against skin
};

/// Measures of an adult's right hand seen from its back: x to the side of the little finger, y along the middle finger, z
/// away from the board. From far to near, as they are painted over one another.
const std::array<Limb, 8> kAdultHand = {{
    {{0.0, -0.28, 0.06}, {0.0, -0.07, 0.03}, 0.040, 0.029},          // forearm
    {{0.0, -0.85, 0.12}, {0.0, -0.22, 0.055}, 0.065, 0.050, 0.45},   // sleeve
    {{-0.032, -0.025, 0.02}, {-0.072, 0.035, 0.014}, 0.016, 0.010},  // thumb
    {{0.033, 0.035, 0.015}, {0.056, 0.090, 0.010}, 0.010, 0.007},    // little finger
    {{0.013, 0.045, 0.016}, {0.022, 0.116, 0.010}, 0.011, 0.008},    // ring finger
    {{-0.009, 0.047, 0.016}, {-0.010, 0.126, 0.010}, 0.011, 0.008},  // middle finger
    {{-0.030, 0.043, 0.016}, {-0.044, 0.112, 0.010}, 0.011, 0.008},  // index finger
    {{-0.012, -0.035, 0.025}, {0.002, 0.022, 0.02}, 0.030, 0.040},   // back of the hand
}};

/// Skin from the outline of a limb to its middle: part of the limb's thickness, and grey level.
struct Tone {
  double thickness_ratio;
  double grey;
};
constexpr std::array<Tone, 6> kSkin = {
    {{1.0, 72.0}, {0.9, 96.0}, {0.78, 112.0}, {0.62, 124.0}, {0.42, 132.0}, {0.2, 136.0}}};

constexpr int kArcPoints = 16;   ///< of half a circle; the polygon leaves it by 0.5 % of the radius
constexpr int kSidePoints = 16;  ///< of a straight side, which the lens bends

/// An outline that spans more than this part of the image straddles a direction that the model cannot image.
constexpr double kMaxStepOfImage = 0.25;

using Outline = std::vector<Eigen::Vector2d>;

/// The flat outline of a limb, counter-clockwise seen from the front, its thickness scaled; in the hand's frame.
std::vector<Eigen::Vector3d> limbOutline(const Limb& limb, double thickness_ratio) {
  const Eigen::Vector2d along = (limb.to_m - limb.from_m).head<2>().normalized();
  const Eigen::Vector2d left(-along.y(), along.x());
  const auto around = [&](const Eigen::Vector3d& centre, double radius_m, double angle_rad) -> Eigen::Vector3d {
    const Eigen::Vector2d offset = thickness_ratio * radius_m * (std::cos(angle_rad) * along + std::sin(angle_rad) * left);
    return centre + Eigen::Vector3d(offset.x(), offset.y(), 0.0);
  };
  std::vector<Eigen::Vector3d> outline;
  const auto add_side = [&outline](const Eigen::Vector3d& end) {
    const Eigen::Vector3d begin = outline.back();
    for (int i = 1; i < kSidePoints; ++i) {
      outline.emplace_back(begin + (end - begin) * i / kSidePoints);
    }
  };
  for (int i = 0; i <= kArcPoints; ++i) {
    outline.push_back(around(limb.to_m, limb.to_radius_m, M_PI * (static_cast<double>(i) / kArcPoints - 0.5)));
  }
  add_side(around(limb.from_m, limb.from_radius_m, 0.5 * M_PI));
  for (int i = 0; i <= kArcPoints; ++i) {
    outline.push_back(around(limb.from_m, limb.from_radius_m, M_PI * (static_cast<double>(i) / kArcPoints + 0.5)));
  }
  add_side(around(limb.to_m, limb.to_radius_m, -0.5 * M_PI));
  return outline;
}

/// Hand frame to target frame, with the hand's size.
Eigen::Vector3d onBoard(const Hand& hand, const Eigen::Vector3d& p_hand) {
  const Eigen::Vector2d up(std::cos(hand.direction_rad), std::sin(hand.direction_rad));
  const Eigen::Vector2d right(up.y(), -up.x());
  const Eigen::Vector2d flat = hand.palm_m + hand.scale * (p_hand.x() * right + p_hand.y() * up);
  return {flat.x(), flat.y(), hand.scale * p_hand.z()};
}

class HandProjector {
 public:
  HandProjector(const Hand& hand, const camera::Camera& camera, const geometry::Rigid3& T_cam_target)
      : hand_(hand), camera_(camera), T_cam_target_(T_cam_target) {}

  /// Empty where a part of the limb has no image.
  Outline outline(const Limb& limb, double thickness_ratio) const {
    const double max_step_px = kMaxStepOfImage * std::max(camera_.width, camera_.height);
    Outline outline;
    for (const Eigen::Vector3d& p_hand : limbOutline(limb, thickness_ratio)) {
      const auto px = camera::project(camera_.model, T_cam_target_ * onBoard(hand_, p_hand));
      if (!px || (!outline.empty() && (*px - outline.back()).norm() > max_step_px)) {
        return {};
      }
      outline.push_back(*px);
    }
    return outline;
  }

  /// The pixels that an outline touches, cut to the image.
  cv::Rect window(const Outline& outline) const {
    if (outline.empty()) {
      return {};
    }
    Eigen::Vector2d low = outline.front();
    Eigen::Vector2d high = outline.front();
    for (const Eigen::Vector2d& px : outline) {
      low = low.cwiseMin(px);
      high = high.cwiseMax(px);
    }
    const auto cut = [](double v, int size) { return static_cast<int>(std::clamp<double>(v, 0.0, size)); };
    const cv::Point begin(cut(low.x() - 1.0, camera_.width), cut(low.y() - 1.0, camera_.height));
    const cv::Point end(cut(high.x() + 2.0, camera_.width), cut(high.y() + 2.0, camera_.height));
    return begin.x < end.x && begin.y < end.y ? cv::Rect(begin, end) : cv::Rect();
  }

 private:
  const Hand& hand_;
  const camera::Camera& camera_;
  const geometry::Rigid3& T_cam_target_;
};

/// Paints one opaque shape over the layer.
void paint(HandLayer& layer, const Outline& outline, const cv::Rect& window, double grey) {
  CoverageBuffer buffer(window);
  for (std::size_t i = 0; i < outline.size(); ++i) {
    buffer.addEdge(outline[i], outline[(i + 1) % outline.size()], 1.0);
  }
  const cv::Mat clamped = cv::max(cv::min(buffer.coverage(), 1.0F), 0.0F);
  const cv::Mat rest = 1.0F - clamped;
  const cv::Rect in_layer = window - layer.window.tl();
  const cv::Mat light = layer.light(in_layer).mul(rest) + grey * clamped;
  light.copyTo(layer.light(in_layer));
  const cv::Mat cover = layer.cover(in_layer).mul(rest) + clamped;
  cover.copyTo(layer.cover(in_layer));
}

}  // namespace

HandLayer drawHand(const Hand& hand, const camera::Camera& camera, const geometry::Rigid3& T_cam_target) {
  const HandProjector projector(hand, camera, T_cam_target);
  std::vector<Limb> seen;
  HandLayer layer;
  for (const Limb& limb : kAdultHand) {
    const cv::Rect window = projector.window(projector.outline(limb, 1.0));
    if (!window.empty()) {
      seen.push_back(limb);
      layer.window |= window;
    }
  }
  layer.cover = cv::Mat1f(layer.window.size(), 0.0F);
  layer.light = cv::Mat1f(layer.window.size(), 0.0F);
  for (const Limb& limb : seen) {
    for (const Tone& tone : kSkin) {
      const Outline outline = projector.outline(limb, tone.thickness_ratio);
      const cv::Rect window = projector.window(outline) & layer.window;
      if (!window.empty()) {
        paint(layer, outline, window, limb.brightness * tone.grey);
      }
    }
  }
  return layer;
}

}  // namespace tartan_calib::simulation
