#include "board_poses.h"

#include <algorithm>
#include <cstdlib>
#include <iterator>
#include <set>

namespace tartan_calib::pipeline {
namespace {

/// A hand that waves a board turns round within a second; a pose interpolated over more than this is a guess of nothing.
constexpr std::int64_t kMaxGap_ns = 500'000'000;

geometry::Rigid3 interpolate(const geometry::Rigid3& a, const geometry::Rigid3& b, double share) {
  return {a.rotation.slerp(share, b.rotation), (1.0 - share) * a.translation + share * b.translation};
}

}  // namespace

BoardPoses::BoardPoses(const calibration::Solution& solution, std::int64_t sync_ns)
    : solution_(solution), sync_ns_(sync_ns) {
  for (std::size_t i = 0; i < solution.views.size(); ++i) {
    const auto& unsolved = solution.unsolved_views;
    if (std::find(unsolved.begin(), unsolved.end(), static_cast<int>(i)) != unsolved.end()) {
      continue;
    }
    view_at_[solution.views[i].stamp_ns] = i;
    for (const observation::CameraView& image : solution.views[i].cameras) {
      images_[{image.camera_index, image.stamp_ns}] = {
          i, std::count_if(image.corners.begin(), image.corners.end(), [](const auto& corner) { return corner.used; })};
    }
  }
}

geometry::Rigid3 BoardPoses::inCamera(int camera_index, const geometry::Rigid3& T_rig_target) const {
  return solution_.rig.cameras[static_cast<std::size_t>(camera_index)].T_cam_rig * T_rig_target;
}

std::optional<geometry::Rigid3> BoardPoses::solved(int camera_index, std::int64_t stamp_ns) const {
  const auto found = images_.find({camera_index, stamp_ns});
  if (found == images_.end()) {
    return std::nullopt;
  }
  return inCamera(camera_index, solution_.T_rig_target[found->second.view]);
}

std::optional<geometry::Rigid3> BoardPoses::explained(const observation::View& view) const {
  std::ptrdiff_t num_used = 0;
  std::size_t num_corners = 0;
  std::set<std::size_t> solved;
  for (const observation::CameraView& image : view.cameras) {
    num_corners += image.corners.size();
    if (const auto found = images_.find({image.camera_index, image.stamp_ns}); found != images_.end()) {
      num_used += found->second.num_used;
      solved.insert(found->second.view);
    }
  }
  const bool is_explained = solved.size() == 1 && num_used > 0 && 2 * num_used >= static_cast<std::ptrdiff_t>(num_corners);
  return is_explained ? std::make_optional(solution_.T_rig_target[*solved.begin()]) : std::nullopt;
}

std::optional<geometry::Rigid3> BoardPoses::guessed(int camera_index, std::int64_t stamp_ns) const {
  const auto after = view_at_.lower_bound(stamp_ns);
  const auto before = after == view_at_.begin() ? view_at_.end() : std::prev(after);
  const auto distance_ns = [&](const auto& entry) {
    return entry == view_at_.end() ? kMaxGap_ns : std::abs(entry->first - stamp_ns);
  };
  const auto nearest = distance_ns(before) < distance_ns(after) ? before : after;
  if (distance_ns(nearest) <= sync_ns_) {
    return inCamera(camera_index, solution_.T_rig_target[nearest->second]);
  }
  if (before == view_at_.end() || after == view_at_.end() || after->first - before->first > kMaxGap_ns) {
    return std::nullopt;
  }
  const double share = static_cast<double>(stamp_ns - before->first) / static_cast<double>(after->first - before->first);
  return inCamera(camera_index,
                  interpolate(solution_.T_rig_target[before->second], solution_.T_rig_target[after->second], share));
}

}  // namespace tartan_calib::pipeline
