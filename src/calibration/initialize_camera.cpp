#include "tartan_calib/calibration/initialize_camera.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <string>
#include <utility>

#include "lens_search.h"
#include "spread.h"
#include "tartan_calib/calibration/pose.h"
#include "tartan_calib/calibration/solve.h"
#include "tartan_calib/error.h"

namespace tartan_calib::calibration {
namespace {

using geometry::Rigid3;
using observation::CameraView;
using Poses = std::vector<std::optional<Rigid3>>;

constexpr std::size_t kMinCorners = 8;       ///< of a view that takes part in the search for a lens
constexpr std::size_t kMinViews = 2;         ///< one image of a plane does not determine a camera
constexpr std::size_t kMaxSearchViews = 40;  ///< more do not make the search safer
constexpr std::size_t kMaxSolveViews = 60;
/// A corner this close to its prediction is explained, as a share of the image's width.
constexpr double kExplained = 2.5e-3;
constexpr double kMinExplained_px = 2.0;
/// Share of explained corners at which no other lens is tried: a quarter may be wrong.
constexpr double kConvincing = 0.7;
constexpr double kFailed = 0.25;
/// Below these numbers the user is told that the start is weak.
constexpr std::size_t kFewViews = 5;
constexpr std::size_t kFewCorners = 200;

std::size_t countPoses(const Poses& poses) {
  return static_cast<std::size_t>(std::count_if(poses.begin(), poses.end(), [](const auto& T) { return T.has_value(); }));
}

std::size_t countCorners(const std::vector<CameraView>& views) {
  std::size_t count = 0;
  for (const CameraView& view : views) {
    count += view.corners.size();
  }
  return count;
}

/// A camera with a pose for each view that it explains.
struct PosedCamera {
  camera::Camera camera;
  Poses poses;
};

/// Intrinsics and existing poses by robust bundle adjustment.
PosedCamera solveCamera(const PosedCamera& start, const std::vector<Eigen::Vector3d>& target_points,
                        const std::vector<CameraView>& views, int num_threads) {
  Problem problem;
  problem.target_points = target_points;
  problem.rig.cameras = {{start.camera, Rigid3()}};
  std::vector<std::size_t> posed;
  for (std::size_t v = 0; v < views.size(); ++v) {
    if (start.poses[v]) {
      CameraView view = views[v];
      view.camera_index = 0;
      problem.views.push_back({view.stamp_ns, {view}});
      problem.T_rig_target.push_back(*start.poses[v]);
      posed.push_back(v);
    }
  }
  SolveOptions options;
  options.num_threads = num_threads;
  options.only_robust = true;
  const Solution solution = solve(problem, options);
  PosedCamera solved{solution.rig.cameras.front().camera, start.poses};
  for (std::size_t i = 0; i < posed.size(); ++i) {
    solved.poses[posed[i]] = solution.T_rig_target[i];
  }
  return solved;
}

/// How well a camera explains corners, wrong ones among them.
struct Explanation {
  double share = 0.0;                                     ///< of all corners that are explained
  double cost = std::numeric_limits<double>::infinity();  ///< mean of Cauchy's loss
};

Explanation explain(const PosedCamera& posed, const std::vector<Eigen::Vector3d>& target_points,
                    const std::vector<CameraView>& views) {
  constexpr double kLost = 100.0;  // squared error of a corner without a prediction, in squared limits
  const double limit_px = std::max(kExplained * posed.camera.width, kMinExplained_px);
  double num_explained = 0.0;
  double cost = 0.0;
  for (std::size_t v = 0; v < views.size(); ++v) {
    for (const observation::Corner& corner : views[v].corners) {
      const Eigen::Vector3d& p_target = target_points[static_cast<std::size_t>(corner.corner_id)];
      const std::optional<Rigid3>& T = posed.poses[v];
      const auto px = T ? camera::project(posed.camera.model, *T * p_target) : std::nullopt;
      const double ratio2 = px ? (*px - corner.px).squaredNorm() / (limit_px * limit_px) : kLost;
      num_explained += ratio2 < 1.0 ? 1.0 : 0.0;
      cost += std::log1p(ratio2);
    }
  }
  const auto num_corners = static_cast<double>(countCorners(views));
  return {num_explained / num_corners, cost / num_corners};
}

/// A solved camera and how well it does.
struct Candidate {
  camera::Camera camera;
  Explanation explanation;
};

/// Solves for the camera, again where that brings back views without a pose.
Candidate tryCamera(const camera::Camera& start, const std::vector<Eigen::Vector3d>& target_points,
                    const std::vector<CameraView>& views, int num_threads) {
  PosedCamera posed{start, estimatePoses(start, target_points, views, num_threads)};
  for (std::size_t num_solved = 0; countPoses(posed.poses) > num_solved;) {
    num_solved = countPoses(posed.poses);
    posed = solveCamera(posed, target_points, views, num_threads);
    for (std::size_t v = 0; v < views.size(); ++v) {
      if (!posed.poses[v]) {
        posed.poses[v] = estimatePose(posed.camera, target_points, views[v].corners);
      }
    }
  }
  return {posed.camera, explain(posed, target_points, views)};
}

/// The best camera of the asked model for a lens.
Candidate tryLens(const CameraSpec& spec, const LensGuess& lens, const std::vector<Eigen::Vector3d>& target_points,
                  const std::vector<CameraView>& views) {
  Candidate best;
  for (const camera::CameraModel& model :
       fitModels(camera::modelByName(spec.model_name), lens.focal_px, lens.centre_px, lens.samples)) {
    const Candidate candidate = tryCamera({model, spec.width, spec.height}, target_points, views, spec.num_threads);
    if (candidate.explanation.cost < best.explanation.cost) {
      best = candidate;
    }
  }
  return best;
}

std::string percent(double share) { return std::to_string(std::lround(100.0 * share)) + " %"; }

std::string degrees(double angle_rad) { return std::to_string(std::lround(angle_rad * 180.0 / M_PI)) + " degrees"; }

[[noreturn]] void throwTooFew(const std::vector<CameraView>& views, std::size_t num_usable) {
  throw CalibrationError("too few corners to start a camera: " + std::to_string(countCorners(views)) + " corners in " +
                         std::to_string(views.size()) + " views, " + std::to_string(num_usable) + " of them with at least " +
                         std::to_string(kMinCorners) + "; needed are " + std::to_string(kMinViews) +
                         " such views with the board at different angles");
}

[[noreturn]] void throwUnexplained(const CameraSpec& spec, const std::vector<CameraView>& views, double share) {
  throw CalibrationError(
      "no " + spec.model_name + " lens explains the corners: at best " + percent(share) + " of " +
      std::to_string(countCorners(views)) + " corners in " + std::to_string(views.size()) +
      " views; check whether the model can represent the lens, the target's sizes, and that the board was "
      "tilted against the image");
}

/// Views from which a lens can be searched.
std::vector<CameraView> usableViews(const std::vector<CameraView>& views) {
  std::vector<CameraView> usable;
  std::copy_if(views.begin(), views.end(), std::back_inserter(usable),
               [](const CameraView& view) { return view.corners.size() >= kMinCorners; });
  return usable;
}

/// The first lens that convinces, or the best.
std::pair<Candidate, LensGuess> findCamera(const CameraSpec& spec, const std::vector<Eigen::Vector3d>& target_points,
                                           const std::vector<CameraView>& views) {
  const ImageInfo image{spec.width, spec.height, spec.focal_hint_px, spec.num_threads};
  std::pair<Candidate, LensGuess> best;
  for (const LensGuess& lens : searchLens(image, target_points, spread(views, kMaxSearchViews))) {
    const Candidate candidate = tryLens(spec, lens, target_points, spread(views, kMaxSolveViews));
    if (candidate.explanation.cost < best.first.explanation.cost) {
      best = {candidate, lens};
    }
    if (best.first.explanation.share > kConvincing) {
      break;
    }
  }
  return best;
}

std::vector<std::string> warningsAbout(const CameraSpec& spec, const std::vector<CameraView>& views,
                                       const Candidate& candidate, const LensGuess& lens) {
  std::vector<std::string> warnings;
  if (views.size() < kFewViews || countCorners(views) < kFewCorners) {
    warnings.push_back("only " + std::to_string(views.size()) + " views with " + std::to_string(countCorners(views)) +
                       " corners: the intrinsics are weakly determined; record the board at more places and angles");
  }
  if (candidate.explanation.share < kConvincing) {
    warnings.push_back("the start explains only " + percent(candidate.explanation.share) +
                       " of the corners: " + spec.model_name + " may not fit this lens, which sees to " +
                       degrees(lens.max_angle_rad) + " from its axis");
  }
  return warnings;
}

}  // namespace

CameraStart initializeCamera(const CameraSpec& spec, const std::vector<Eigen::Vector3d>& target_points,
                             const std::vector<CameraView>& views) {
  if (spec.known_model) {
    return {{*spec.known_model, spec.width, spec.height}, {}};
  }
  const std::vector<CameraView> usable = usableViews(views);
  if (usable.size() < kMinViews) {
    throwTooFew(views, usable.size());
  }
  const auto [candidate, lens] = findCamera(spec, target_points, usable);
  if (candidate.explanation.share < kFailed) {
    throwUnexplained(spec, usable, candidate.explanation.share);
  }
  return {candidate.camera, warningsAbout(spec, usable, candidate, lens)};
}

}  // namespace tartan_calib::calibration
