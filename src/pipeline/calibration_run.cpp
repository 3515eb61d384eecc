#include "calibration_run.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "board_poses.h"
#include "check_options.h"
#include "check_solution.h"
#include "listen.h"
#include "pupil_hint.h"
#include "recover_corners.h"
#include "round_summary.h"
#include "tartan_calib/calibration/initialize_camera.h"
#include "tartan_calib/calibration/initialize_rig.h"
#include "tartan_calib/calibration/synchronize.h"
#include "tartan_calib/pipeline/warnings.h"
#include "tartan_calib/text.h"

namespace tartan_calib::pipeline {
namespace {

using observation::CameraView;
using observation::Corner;

constexpr std::size_t kMinCorners = 4;  ///< fewer determine no pose

bool isUsed(const Corner& corner) { return corner.used; }

/// Why no image of a camera can take part, and what helps.
std::string noUsableImages(const CameraCorners& corners, const target::Target& target, int min_tags) {
  std::string text = "none of its " + std::to_string(corners.num_images) + " images shows ";
  const std::optional<std::string> note = boardNote(corners, target);
  const auto* grid = std::get_if<target::AprilGrid>(&target);
  if (corners.images.empty() || grid == nullptr) {
    text += "the target: " + note.value_or("check target file, focus and exposure");
  } else {
    int most = 0;
    for (const CameraView& image : corners.images) {
      most = std::max(most, countTags(*grid, image.corners));
    }
    text += std::to_string(min_tags) + " tags, the smallest number for taking part; the best shows " + std::to_string(most) +
            ": " + note.value_or("come closer with the board, or check the target's tagRows and tagCols");
  }
  return text;
}

/// Images of all cameras that are not in the solution.
std::vector<CameraView> unusedImages(const std::vector<CameraCorners>& cameras, const calibration::Solution& solution) {
  std::set<std::pair<int, std::int64_t>> in_solution;
  for (const observation::View& view : solution.views) {
    for (const CameraView& image : view.cameras) {
      in_solution.emplace(image.camera_index, image.stamp_ns);
    }
  }
  std::vector<CameraView> unused;
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    for (CameraView image : cameras[i].images) {
      image.camera_index = static_cast<int>(i);
      if (in_solution.count({image.camera_index, image.stamp_ns}) > 0) {
        continue;
      }
      for (Corner& corner : image.corners) {
        corner.used = false;
      }
      unused.push_back(std::move(image));
    }
  }
  return unused;
}

void countUsedImages(const calibration::Solution& solution, std::vector<CameraReport>& cameras) {
  for (const observation::View& view : solution.views) {
    for (const CameraView& image : view.cameras) {
      const bool has_used = std::any_of(image.corners.begin(), image.corners.end(), isUsed);
      cameras[static_cast<std::size_t>(image.camera_index)].num_images_used += has_used ? 1 : 0;
    }
  }
}

}  // namespace

CalibrationRun::CalibrationRun(std::size_t num_cameras, const target::Target& target, const CalibrateOptions& options,
                               const Listener& listener)
    : target_(target),
      options_(options),
      listener_(listener),
      target_points_(target::cornerPoints(target)),
      known_rig_(options.known_rig) {
  checkOptions(options, target, num_cameras);
  result_.target = target;
}

void CalibrationRun::warn(const std::string& text) {
  result_.warnings.push_back(text);
  if (listener_.warning) {
    listener_.warning(text);
  }
}

void CalibrationRun::begin(Stage stage, int camera_index) {
  throwIfCancelled(listener_);
  stage_ = Progress{stage, camera_index, 0, 1};
  stage_begin_ = Clock::now();
  report(listener_, stage_);
}

void CalibrationRun::end() {
  const std::chrono::duration<double> taken = Clock::now() - stage_begin_;
  result_.times.push_back({stage_.stage, stage_.camera_index, taken.count()});
  stage_.done = stage_.total = 1;
  report(listener_, stage_);
}

std::vector<CameraView> CalibrationRun::usableImages(const CameraCorners& corners, int camera_index) const {
  const auto* grid = std::get_if<target::AprilGrid>(&target_);
  const int min_tags = grid == nullptr ? 0 : options_.min_tags.value_or(minTags(*grid));
  std::vector<CameraView> usable;
  for (const CameraView& image : corners.images) {
    if (image.corners.size() < kMinCorners || (grid != nullptr && countTags(*grid, image.corners) < min_tags)) {
      continue;
    }
    usable.push_back(image);
    usable.back().camera_index = camera_index;
  }
  if (usable.empty()) {
    throw CalibrationError(noUsableImages(corners, target_, min_tags));
  }
  return usable;
}

void CalibrationRun::addCamera(const CameraCorners& corners, std::optional<double> seconds) {
  const int index = static_cast<int>(corners_.size());
  checkCorners(corners, index, static_cast<int>(target_points_.size()));
  if (seconds) {
    result_.times.push_back({Stage::kDetect, index, *seconds});
  }
  for (const std::string& warning : detectionWarnings(corners, index, target_)) {
    warn(warning);
  }
  begin(Stage::kStartCamera, index);
  const calibration::CameraSpec spec = cameraSpec(options_, corners, index);
  try {
    usable_.push_back(usableImages(corners, index));
    const calibration::CameraStart start = calibration::initializeCamera(spec, target_points_, usable_.back());
    for (const std::string& warning : start.warnings) {
      warn(cameraName(index) + ": " + warning);
    }
    started_.push_back(start.camera);
  } catch (const CalibrationError& error) {
    throw CalibrationError("Could not initialize the intrinsics for camera with topic: " + corners.topic + ": " +
                           error.what());
  }
  corners_.push_back(corners);
  end();
  if (listener_.camera_started) {
    listener_.camera_started(index, started_.back());
  }
}

calibration::Problem CalibrationRun::startRig() {
  begin(Stage::kStartRig);
  const std::vector<observation::View> views = calibration::synchronize(usable_, options_.approx_sync_ns);
  result_.graph = calibration::cameraGraph(views, static_cast<int>(started_.size()));
  const BoardPoses poses(result_.solution, options_.approx_sync_ns);
  std::vector<std::optional<geometry::Rigid3>> known_poses;
  for (const observation::View& view : views) {
    known_poses.push_back(poses.explained(view));
  }
  calibration::Problem problem =
      calibration::initializeRig(started_, target_points_, views, {known_rig_, known_poses, options_.num_threads});
  result_.num_dropped_views = static_cast<int>(views.size() - problem.views.size());
  end();
  return problem;
}

calibration::SolveOptions CalibrationRun::solveOptions() const {
  calibration::SolveOptions options = options_.solve;
  options.num_threads = options_.num_threads;
  // A round starts from a solution, which robust losses would leave where cameras disagree.
  options.anneal_robust_loss = options.anneal_robust_loss && result_.solution.views.empty();
  options.progress = [this, stage = stage_.stage](const calibration::SolveProgress& progress) {
    constexpr std::size_t kTotal = 100;
    const double percent = std::ceil(kTotal * calibration::doneShare(progress));
    report(listener_, {stage, -1, std::min(static_cast<std::size_t>(percent), kTotal - 1), kTotal});
    return !isCancelled(listener_);
  };
  return options;
}

void CalibrationRun::solve(const calibration::Problem& problem) {
  begin(Stage::kSolve);
  result_.solution = calibration::solve(problem, solveOptions());
  if (result_.solution.status == calibration::SolveStatus::kCancelled) {
    throw Cancelled("the calibration was stopped");
  }
  end();
}

void CalibrationRun::solveTogether() {
  const calibration::Problem problem = startRig();
  if (listener_.rig_started) {
    listener_.rig_started(problem);
  }
  solve(problem);
  checkSolution(result_.solution, !known_rig_);
}

std::vector<CameraCorners> CalibrationRun::recoverAll(const std::vector<CameraStream>& streams) {
  const calibration::Solution& solution = result_.solution;
  const BoardPoses poses(solution, options_.approx_sync_ns);
  const detection::CornerRecovery recovery(target_, options_.recovery);
  const std::vector<Eigen::Vector3d> bent_points = calibration::warpedPoints(target_points_, solution.board_warp_m);
  const BoardShape shape{calibration::BoardBend(target_points_), solution.board_warp_m};
  const RoundStart start{solution, poses, bent_points, shape};
  searched_.resize(streams.size());
  const double half_window_m = options_.recovery.symmetry_window * target::symmetricHalfWidth(target_);
  std::vector<CameraCorners> recovered;
  for (std::size_t i = 0; i < streams.size(); ++i) {
    begin(Stage::kRecover, static_cast<int>(i));
    const ViewDetection views(solution.rig.cameras[i].camera, target_, options_.projections, options_.detector);
    const RoundSearch search{options_.max_rounds > 0 ? &recovery : nullptr, views, half_window_m, searched_[i]};
    recovered.push_back(recoverCorners(streams[i], static_cast<int>(i), search, start, corners_[i], options_, listener_));
    end();
  }
  return recovered;
}

void CalibrationRun::solveAgain(RoundSummary& summary) {
  known_rig_ = result_.solution.rig;
  for (std::size_t i = 0; i < corners_.size(); ++i) {
    started_[i] = known_rig_->cameras[i].camera;
    usable_[i] = imagesWithCorners(corners_[i]);
  }
  solve(startRig());
  checkSolution(result_.solution, !options_.known_rig);
  describeSolution(*known_rig_, result_.solution, target_points_, summary);
}

bool CalibrationRun::runRound(const std::vector<CameraStream>& streams) {
  std::vector<CameraCorners> recovered = recoverAll(streams);
  RoundSummary summary = compareCorners(corners_, recovered);
  summary.round = static_cast<int>(result_.rounds.size()) + 1;
  keepRounds(corners_, summary.round, recovered);
  std::swap(corners_, recovered);
  CalibrationResult before = result_;
  try {
    solveAgain(summary);
  } catch (const CalibrationError& error) {
    corners_ = std::move(recovered);
    result_ = std::move(before);
    warn(format("round %d did not end with a calibration, that of the round before is kept; ", summary.round) +
         error.what());
    return false;
  }
  rejected_.update(recovered, corners_);
  result_.rounds.push_back(summary);
  if (listener_.round_finished) {
    listener_.round_finished(summary);
  }
  return !isSettled(summary);
}

void CalibrationRun::describe(CalibrationResult& result) const {
  const std::vector<calibration::CameraStatistics> statistics =
      calibration::residualStatistics(result.solution, target_points_);
  for (std::size_t i = 0; i < corners_.size(); ++i) {
    const CameraCorners& corners = corners_[i];
    result.cameras.push_back({corners.topic, corners.num_images, corners.images.size(), 0, corners.counts, statistics[i]});
  }
  result.unused_images = unusedImages(corners_, result.solution);
  countUsedImages(result.solution, result.cameras);
  rejected_.addTo(result);
}

CalibrationResult CalibrationRun::finish() {
  begin(Stage::kStatistics);
  const std::optional<std::string> pupil_hint = pupilHint(result_.solution, solveOptions(), target_points_);
  describe(result_);
  for (const std::string& warning : resultWarnings(result_)) {
    warn(warning);
  }
  if (pupil_hint) {
    warn(*pupil_hint);
  }
  end();
  return std::move(result_);
}

CalibrationResult CalibrationRun::current() const {
  CalibrationResult result = result_;
  describe(result);
  for (const std::string& warning : resultWarnings(result)) {
    result.warnings.push_back(warning);
  }
  return result;
}

}  // namespace tartan_calib::pipeline
