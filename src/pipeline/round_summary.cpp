#include "round_summary.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <tuple>

#include "tartan_calib/calibration/compare.h"

namespace tartan_calib::pipeline {
namespace {

using CornerKey = std::tuple<std::size_t, std::int64_t, int>;

constexpr std::size_t kMinCorners = 4;  ///< fewer determine no pose
constexpr double kSettledGain = 0.01;   ///< of all corners
constexpr double kSettledChange_px = 0.02;
constexpr double kGridCells = 24.0;  ///< over the image's width

/// Calls `visit(key, corner)` for every corner.
template <typename Cameras, typename Visit>
void forEachCorner(Cameras& cameras, const Visit& visit) {
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    for (auto& image : cameras[i].images) {
      for (auto& corner : image.corners) {
        visit(CornerKey{i, image.stamp_ns, corner.corner_id}, corner);
      }
    }
  }
}

std::set<CornerKey> cornerKeys(const std::vector<CameraCorners>& cameras) {
  std::set<CornerKey> keys;
  forEachCorner(cameras, [&keys](const CornerKey& key, const observation::Corner& /*corner*/) { keys.insert(key); });
  return keys;
}

int countMissing(const std::set<CornerKey>& keys, const std::set<CornerKey>& from) {
  return static_cast<int>(
      std::count_if(keys.begin(), keys.end(), [&](const CornerKey& key) { return from.count(key) == 0; }));
}

}  // namespace

std::vector<observation::CameraView> imagesWithCorners(const CameraCorners& corners) {
  std::vector<observation::CameraView> images;
  for (const observation::CameraView& image : corners.images) {
    if (image.corners.size() >= kMinCorners) {
      images.push_back(image);
      for (observation::Corner& corner : images.back().corners) {
        corner.used = true;
      }
    }
  }
  return images;
}

RoundSummary compareCorners(const std::vector<CameraCorners>& before, const std::vector<CameraCorners>& after) {
  const std::set<CornerKey> keys_before = cornerKeys(before);
  const std::set<CornerKey> keys_after = cornerKeys(after);
  RoundSummary summary;
  summary.gained = countMissing(keys_after, keys_before);
  summary.lost = countMissing(keys_before, keys_after);
  return summary;
}

void keepRounds(const std::vector<CameraCorners>& before, int round, std::vector<CameraCorners>& after) {
  std::map<CornerKey, int> first_rounds;
  forEachCorner(before, [&](const CornerKey& key, const observation::Corner& corner) { first_rounds[key] = corner.round; });
  forEachCorner(after, [&](const CornerKey& key, observation::Corner& corner) {
    const auto first = first_rounds.find(key);
    corner.round = first == first_rounds.end() ? round : first->second;
  });
}

void describeSolution(const calibration::Rig& before, const calibration::Solution& solution,
                      const std::vector<Eigen::Vector3d>& target_points, RoundSummary& summary) {
  double sum_px2 = 0.0;
  for (const calibration::CameraStatistics& statistics : calibration::residualStatistics(solution, target_points)) {
    summary.corners += statistics.num_corners;
    sum_px2 += statistics.rms_px * statistics.rms_px * statistics.num_corners;
  }
  summary.rms_px = summary.corners > 0 ? std::sqrt(sum_px2 / summary.corners) : 0.0;
  for (std::size_t i = 0; i < before.cameras.size(); ++i) {
    const camera::Camera& camera = before.cameras[i].camera;
    const auto grid = calibration::imageGrid(camera.width, camera.height, camera.width / kGridCells);
    const auto difference = calibration::compareProjections(camera.model, solution.rig.cameras[i].camera.model, grid);
    summary.model_change_px = std::max(summary.model_change_px, difference.rms_px);
  }
}

bool isSettled(const RoundSummary& summary) {
  return summary.gained < kSettledGain * summary.corners && summary.model_change_px < kSettledChange_px;
}

}  // namespace tartan_calib::pipeline
