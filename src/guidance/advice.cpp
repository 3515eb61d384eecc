#include "tartan_calib/guidance/advice.h"

#include <algorithm>
#include <array>
#include <optional>

#include "tartan_calib/text.h"

namespace tartan_calib::guidance {
namespace {

constexpr double kCloser_ratio = 0.8;  ///< of the distance: less is no order to a hand
constexpr double kFarther_ratio = 1.25;
constexpr double kCloseUp_ratio = 0.5;  ///< of the image's shorter side that the board should fill once
constexpr double kCloseUpWeight = 0.4;  ///< of its lack, where all tilts or all regions would be 1
constexpr std::array<Tilt, 4> kTilts = {Tilt::kLeft, Tilt::kRight, Tilt::kUp, Tilt::kDown};

/// What one camera lacks, as a share of what it should have, and what to do about it.
struct Lack {
  double share = 0.0;
  std::string advice;
};

std::string tiltText(Tilt tilt) {
  switch (tilt) {
    case Tilt::kLeft:
      return "tilt the board to the left";
    case Tilt::kRight:
      return "tilt the board to the right";
    case Tilt::kUp:
      return "tilt the board upwards";
    case Tilt::kDown:
      return "tilt the board downwards";
    case Tilt::kNone:
      break;
  }
  return "turn the board to face the camera";
}

Lack missingTilts(const CameraCollection& camera) {
  std::optional<Tilt> first;
  int num_missing = 0;
  for (const Tilt tilt : kTilts) {
    const bool is_seen =
        std::any_of(camera.shapes.begin(), camera.shapes.end(), [&](const BoardShape& shape) { return shape.tilt == tilt; });
    num_missing += is_seen ? 0 : 1;
    first = is_seen || first ? first : std::make_optional(tilt);
  }
  return {static_cast<double>(num_missing) / static_cast<double>(kTilts.size()), first ? tiltText(*first) : ""};
}

/// Of the regions without corners the one farthest from where the board was.
Lack missingRegions(const CameraCollection& camera) {
  const std::vector<Region> empty = camera.coverage.emptyRegions();
  if (empty.empty()) {
    return {};
  }
  Eigen::Vector2d mean_px = Eigen::Vector2d::Zero();
  for (const BoardShape& shape : camera.shapes) {
    mean_px += shape.centre_px / static_cast<double>(camera.shapes.size());
  }
  const auto distance = [&](const Region& region) {
    const Eigen::Vector2d middle_px((region.col + 0.5) * camera.coverage.width() / kRegionsPerSide,
                                    (region.row + 0.5) * camera.coverage.height() / kRegionsPerSide);
    return (middle_px - mean_px).norm();
  };
  const auto farthest = std::max_element(empty.begin(), empty.end(),
                                         [&](const Region& a, const Region& b) { return distance(a) < distance(b); });
  return {static_cast<double>(empty.size()) / static_cast<double>(camera.coverage.litRegions().size()),
          "go to the " + regionName(*farthest)};
}

Lack missingCloseUp(const CameraCollection& camera) {
  const double wanted_px = kCloseUp_ratio * std::min(camera.coverage.width(), camera.coverage.height());
  const bool is_seen = std::any_of(camera.shapes.begin(), camera.shapes.end(),
                                   [&](const BoardShape& shape) { return shape.size_px >= wanted_px; });
  return is_seen ? Lack{} : Lack{kCloseUpWeight, "come closer"};
}

Lack largestLack(const CameraCollection& camera) {
  if (camera.shapes.empty()) {
    return {2.0, "show the whole board"};  // more than any share
  }
  const std::array<Lack, 3> lacks = {missingTilts(camera), missingRegions(camera), missingCloseUp(camera)};
  return *std::max_element(lacks.begin(), lacks.end(), [](const Lack& a, const Lack& b) { return a.share < b.share; });
}

std::string groupAdvice(const calibration::CameraGraph& graph) {
  return "show the board to " + cameraName(graph.groups[0].back()) + " and " + cameraName(graph.groups[1].front()) +
         " at the same time";
}

}  // namespace

std::string coverageAdvice(const std::vector<CameraCollection>& cameras, const calibration::CameraGraph& graph) {
  std::size_t worst = 0;
  std::vector<Lack> lacks;
  for (const CameraCollection& camera : cameras) {
    lacks.push_back(largestLack(camera));
    worst = lacks.back().share > lacks[worst].share ? lacks.size() - 1 : worst;
  }
  const bool all_seen =
      std::none_of(cameras.begin(), cameras.end(), [](const auto& camera) { return camera.shapes.empty(); });
  if (all_seen && graph.groups.size() > 1) {
    return groupAdvice(graph);
  }
  if (lacks[worst].advice.empty()) {
    return "hold the board elsewhere";
  }
  return (cameras.size() > 1 ? cameraName(worst) + ": " : "") + lacks[worst].advice;
}

std::string moveAdvice(const BoardPlacement& from, const BoardPlacement& to, const camera::Camera& camera) {
  std::vector<std::string> parts;
  const Region region = regionOf(to.centre_px, camera.width, camera.height);
  if (!(region == regionOf(from.centre_px, camera.width, camera.height))) {
    parts.push_back("go to the " + regionName(region));
  }
  if (to.distance_m < kCloser_ratio * from.distance_m) {
    parts.emplace_back("closer");
  } else if (to.distance_m > kFarther_ratio * from.distance_m) {
    parts.emplace_back("farther away");
  }
  if (to.tilt != from.tilt) {
    parts.push_back(tiltText(to.tilt));
  }
  return parts.empty() ? "hold still near the outline" : joined(parts);
}

std::string placeAdvice(const BoardPlacement& to, const camera::Camera& camera) {
  return "show the board in the " + regionName(regionOf(to.centre_px, camera.width, camera.height));
}

}  // namespace tartan_calib::guidance
