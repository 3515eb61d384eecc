#include "recover_corners.h"

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "merge_corners.h"
#include "stream_images.h"
#include "tartan_calib/calibration/pose.h"

namespace tartan_calib::pipeline {
namespace {

using observation::CameraView;
using observation::Corner;

/// A corner of an earlier round that was neither solved with nor found again stays while it is this close to the prediction.
constexpr double kKeptWithin_px = 1.0;
/// Corners needed to turn a guessed pose into an estimated one.
constexpr std::size_t kMinPoseCorners = 8;

std::vector<Corner> joined(std::vector<Corner> corners, const std::vector<Corner>& more) {
  corners.insert(corners.end(), more.begin(), more.end());
  return corners;
}

/// Adds corners of the earlier round that the new one does not have and that still fit: those that the solve used, and those
/// close to their predictions.
void keepEarlier(const std::vector<Corner>& earlier, const std::set<int>& used, const detection::BoardMap& map,
                 const std::vector<Eigen::Vector3d>& target_points, std::vector<Corner>& corners) {
  std::set<int> found;
  for (const Corner& corner : corners) {
    found.insert(corner.corner_id);
  }
  for (const Corner& corner : earlier) {
    const auto px = map(target_points[static_cast<std::size_t>(corner.corner_id)].head<2>());
    const bool is_close = px && (*px - corner.px).norm() <= kKeptWithin_px;
    if (found.count(corner.corner_id) == 0 && (is_close || used.count(corner.corner_id) > 0)) {
      corners.push_back(corner);
    }
  }
  std::sort(corners.begin(), corners.end(), [](const Corner& a, const Corner& b) { return a.corner_id < b.corner_id; });
}

struct RecoveredImage {
  CameraView view;
  std::optional<SearchedImage> searched;  ///< empty where the image was left alone
};

/// One camera's images in one round. Const: images are worked on by several threads.
class ImageRecovery {
 public:
  ImageRecovery(int camera_index, const RoundSearch& search, const RoundStart& start, const CameraCorners& previous)
      : camera_index_(camera_index),
        camera_(start.solution.rig.cameras[static_cast<std::size_t>(camera_index)].camera),
        search_(search),
        start_(start) {
    for (const CameraView& image : previous.images) {
      earlier_[image.stamp_ns] = &image.corners;
    }
    for (const observation::View& view : start.solution.views) {
      for (const CameraView& image : view.cameras) {
        if (image.camera_index == camera_index) {
          rememberUsed(image);
        }
      }
    }
  }

  RecoveredImage recover(const StampedImage& image) const {
    RecoveredImage result{{camera_index_, image.stamp_ns, earlierIn(image.stamp_ns)}, {}};
    CameraView& view = result.view;
    const auto map = predict(image.stamp_ns, view.corners);
    if (map ? !needsSearch(image.stamp_ns, *map) : search_.views.empty()) {
      return result;
    }
    try {
      const cv::Mat gray = image.load();
      const bool is_calibrated_size = gray.cols == camera_.width && gray.rows == camera_.height;
      view.corners = is_calibrated_size ? recoverFrom(gray, view) : std::vector<Corner>();
    } catch (const InputError&) {
      // Counted when the images were read for the first time; one that has become unreadable keeps its corners.
    }
    if (map) {
      const int num_predicted = countPredicted(camera_, *map, start_.target_points);
      result.searched = {*map, static_cast<int>(view.corners.size()) >= num_predicted};
    }
    return result;
  }

 private:
  bool needsSearch(std::int64_t stamp_ns, const detection::BoardMap& map) const {
    const auto before = search_.history.find(stamp_ns);
    return before == search_.history.end() || hasMoved(before->second, camera_, map, start_.target_points);
  }

  void rememberUsed(const CameraView& image) {
    for (const Corner& corner : image.corners) {
      if (corner.used) {
        used_[image.stamp_ns].insert(corner.corner_id);
      }
    }
  }

  std::set<int> usedIn(std::int64_t stamp_ns) const {
    const auto found = used_.find(stamp_ns);
    return found == used_.end() ? std::set<int>() : found->second;
  }

  std::vector<Corner> earlierIn(std::int64_t stamp_ns) const {
    const auto found = earlier_.find(stamp_ns);
    return found == earlier_.end() ? std::vector<Corner>() : *found->second;
  }

  /// From the solution, else from the corners, else from the views next in time.
  std::optional<geometry::Rigid3> poseOf(std::int64_t stamp_ns, const std::vector<Corner>& corners) const {
    auto T_cam_target = start_.poses.solved(camera_index_, stamp_ns);
    if (!T_cam_target) {
      T_cam_target = calibration::estimatePose(camera_, start_.target_points, corners);
    }
    return T_cam_target ? T_cam_target : start_.poses.guessed(camera_index_, stamp_ns);
  }

  std::optional<detection::BoardMap> predict(std::int64_t stamp_ns, const std::vector<Corner>& corners) const {
    const auto T_cam_target = poseOf(stamp_ns, corners);
    return T_cam_target ? std::make_optional(boardMap(camera_, *T_cam_target, start_.shape)) : std::nullopt;
  }

  std::vector<Corner> recoverFrom(const cv::Mat& gray, const CameraView& earlier) const {
    std::vector<Corner> seen = search_.views.detect(gray);
    const auto T_cam_target = poseOf(earlier.stamp_ns, joined(earlier.corners, seen));
    if (!T_cam_target) {
      return earlier.corners;
    }
    seen = joined(seen, search_.views.detectRectified(gray, *T_cam_target));
    detection::BoardMap map = boardMap(camera_, *T_cam_target, start_.shape);
    std::vector<Corner> corners = earlier.corners;
    if (search_.recovery != nullptr) {
      corners = recoverWith(gray, start_.poses.solved(camera_index_, earlier.stamp_ns).has_value(), map);
      keepEarlier(earlier.corners, usedIn(earlier.stamp_ns), map, start_.target_points, corners);
    }
    seen = refineInImage(gray, map, start_.target_points, search_.half_window_m, seen);
    mergeCorners(seen, map, start_.target_points, corners);
    return corners;
  }

  /// Replaces a guessed map by a better one.
  std::vector<Corner> recoverWith(const cv::Mat& gray, bool is_solved, detection::BoardMap& map) const {
    std::vector<Corner> corners = search_.recovery->recover(gray, map);
    if (!is_solved && corners.size() >= kMinPoseCorners) {
      // The pose was a guess; what was found with it gives a better one, which finds more.
      if (const auto better = calibration::estimatePose(camera_, start_.target_points, corners)) {
        map = boardMap(camera_, *better, start_.shape);
        corners = search_.recovery->recover(gray, map);
      }
    }
    return corners;
  }

  int camera_index_;
  const camera::Camera& camera_;
  const RoundSearch& search_;
  const RoundStart& start_;
  std::map<std::int64_t, const std::vector<Corner>*> earlier_;
  std::map<std::int64_t, std::set<int>> used_;  ///< by the solution, ids by image
};

}  // namespace

CameraCorners recoverCorners(const CameraStream& stream, int camera_index, const RoundSearch& search,
                             const RoundStart& start, const CameraCorners& previous, const CalibrateOptions& options,
                             const Listener& listener) {
  const ImageRecovery images(camera_index, search, start, previous);
  CameraCorners corners = previous;
  corners.images.clear();
  SearchHistory searched;  // joins the history afterwards: workers read that
  streamImages<RecoveredImage>(
      stream, options.num_threads, listener, {Stage::kRecover, camera_index, 0, 0},
      [&images](const StampedImage& image) { return images.recover(image); },
      [&](RecoveredImage image) {
        if (image.searched) {
          searched[image.view.stamp_ns] = *image.searched;
        }
        const bool is_new = corners.images.empty() || corners.images.back().stamp_ns < image.view.stamp_ns;
        if (is_new && !image.view.corners.empty()) {
          corners.images.push_back(std::move(image.view));
        }
      });
  for (auto& [stamp_ns, image] : searched) {
    search.history[stamp_ns] = image;
  }
  return corners;
}

}  // namespace tartan_calib::pipeline
