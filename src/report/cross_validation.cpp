#include "tartan_calib/report/cross_validation.h"

#include <algorithm>
#include <cmath>

#include "listen.h"

namespace tartan_calib::report {
namespace {

constexpr std::size_t kMinViews = 3;  ///< of a half and camera; two leave most lenses undetermined

calibration::Problem halfProblem(const pipeline::CalibrationResult& result, std::size_t remainder) {
  const calibration::Solution& solution = result.solution;
  calibration::Problem half;
  half.target_points = target::cornerPoints(result.target);
  half.rig = solution.rig;
  half.board_warp_m = solution.board_warp_m;
  for (std::size_t view = remainder; view < solution.views.size(); view += 2) {
    observation::View used{solution.views[view].stamp_ns, {}};
    for (const observation::CameraView& image : solution.views[view].cameras) {
      used.cameras.push_back({image.camera_index, image.stamp_ns, {}});
      for (const observation::Corner& corner : image.corners) {
        if (corner.used) {
          used.cameras.back().corners.push_back(corner);
        }
      }
      if (used.cameras.back().corners.empty()) {
        used.cameras.pop_back();
      }
    }
    if (!used.cameras.empty()) {
      half.views.push_back(used);
      half.T_rig_target.push_back(solution.T_rig_target[view]);
    }
  }
  return half;
}

bool hasViewsEnough(const calibration::Problem& half) {
  std::vector<std::size_t> num_views(half.rig.cameras.size(), 0);
  for (const observation::View& view : half.views) {
    for (const observation::CameraView& image : view.cameras) {
      ++num_views[static_cast<std::size_t>(image.camera_index)];
    }
  }
  return *std::min_element(num_views.begin(), num_views.end()) >= kMinViews;
}

}  // namespace

std::optional<std::array<calibration::Solution, 2>> solveHalves(const pipeline::CalibrationResult& result,
                                                                const pipeline::CalibrateOptions& options,
                                                                const Listener& listener) {
  calibration::SolveOptions solve = options.solve;
  if (solve.fix_intrinsics) {
    return std::nullopt;
  }
  solve.num_threads = options.num_threads;
  solve.anneal_robust_loss = false;  // the corners are sorted out, and the start is good
  solve.remove_outliers = false;
  solve.final_filtering = false;
  std::array<calibration::Solution, 2> halves;
  for (std::size_t remainder = 0; remainder < 2; ++remainder) {
    const calibration::Problem half = halfProblem(result, remainder);
    if (!hasViewsEnough(half)) {
      return std::nullopt;
    }
    solve.progress = [&listener, remainder](const calibration::SolveProgress& progress) {
      constexpr std::size_t kTotal = 100;
      if (listener.progress) {
        const double percent = std::ceil(0.5 * kTotal * (static_cast<double>(remainder) + calibration::doneShare(progress)));
        listener.progress(std::min(static_cast<std::size_t>(percent), kTotal), kTotal);
      }
      return !isCancelled(listener);
    };
    halves[remainder] = calibration::solve(half, solve);
    if (halves[remainder].status == calibration::SolveStatus::kCancelled) {
      throw pipeline::Cancelled("the report was stopped");
    }
    if (halves[remainder].status != calibration::SolveStatus::kConverged) {
      return std::nullopt;
    }
  }
  return halves;
}

}  // namespace tartan_calib::report
