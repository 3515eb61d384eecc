#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "tartan_calib/calibration/camera_graph.h"
#include "tartan_calib/calibration/rig.h"
#include "tartan_calib/calibration/solve.h"
#include "tartan_calib/calibration/statistics.h"
#include "tartan_calib/camera/camera.h"
#include "tartan_calib/detection/corner_recovery.h"
#include "tartan_calib/detection/target_detector.h"
#include "tartan_calib/error.h"
#include "tartan_calib/observation/observation.h"
#include "tartan_calib/pipeline/camera_stream.h"
#include "tartan_calib/pipeline/virtual_view.h"
#include "tartan_calib/target/target.h"

namespace tartan_calib::pipeline {

/// Everything that can be chosen about a run, with Kalibr's defaults where Kalibr has the choice.
struct CalibrateOptions {
  std::vector<std::string> models;            ///< one name per camera, e.g. ds-none
  std::optional<double> focal_hint_px;        ///< image scale in the centre of every camera
  std::optional<calibration::Rig> known_rig;  ///< start from this calibration, camera by camera
  detection::DetectorOptions detector;        ///< Kalibr's filters
  std::optional<int> min_tags;                ///< AprilGrid: images with fewer stay out of the solve; default minTags()
  std::int64_t approx_sync_ns = 20'000'000;   ///< largest distance of an image's stamp from its view's
  int num_threads = 0;                        ///< of every stage (replaces solve.num_threads); 0: all cores
  /// After the first solve the images are gone through again with the model, until fewer than 1 % of the corners are gained
  /// and the model moves less than 0.02 px, at most so often; 0: not at all, as Kalibr.
  int max_rounds = 5;
  /// Views in which every round detects the board too, remapped with its model; where there are no rounds, one such pass.
  Projections projections;
  detection::RecoveryOptions recovery;
  calibration::SolveOptions solve;
};

/// Kalibr's smallest number of tags in an image that takes part: max(rows, cols) + 1, but never more than the board has.
int minTags(const target::AprilGrid& grid);

/// Distinct tags of which at least one corner was seen.
int countTags(const target::AprilGrid& grid, const std::vector<observation::Corner>& corners);

/// What one camera saw: the arrow between detection and calibration, which a corners file stores.
struct CameraCorners {
  std::string topic;
  int width = 0;
  int height = 0;
  std::vector<observation::CameraView> images;  ///< those with corners, by increasing stamp
  std::size_t num_images = 0;                   ///< all that were looked at
  std::size_t num_other_size = 0;               ///< skipped: not of the size that most images have
  std::size_t num_unreadable = 0;               ///< skipped: could not be decoded
  std::string unreadable_reason;                ///< of the first one
  std::size_t num_same_stamp = 0;               ///< skipped: same stamp as the image before
  detection::DetectionCounts counts;            ///< summed over the images
};

enum class Stage { kDetect, kStartCamera, kStartRig, kSolve, kRecover, kStatistics };

/// `detect`, `start camera`, ...
std::string stageName(Stage stage);

struct Progress {
  Stage stage = Stage::kDetect;
  int camera_index = -1;  ///< -1 where the stage is about all cameras
  std::size_t done = 0;   ///< images; percent of a solve, as far as it can be known; otherwise 0, then 1
  std::size_t total = 0;
};

/// What one pass over the images with the intermediate model changed.
struct RoundSummary {
  int round = 0;                 ///< from 1; round 0 is the detection
  int corners = 0;               ///< used by the solve after the round
  int gained = 0;                ///< seen now and not in the round before
  int lost = 0;                  ///< the reverse
  double rms_px = 0.0;           ///< sqrt(mean |residual|^2) of the used corners
  double model_change_px = 0.0;  ///< rms over the image, of the camera that changed most, common rotation removed
};

/// What is known about one camera besides its calibration.
struct CameraReport {
  std::string topic;
  std::size_t num_images = 0;           ///< looked at
  std::size_t num_images_detected = 0;  ///< with at least one corner
  std::size_t num_images_used = 0;      ///< with a corner that the last solve used
  detection::DetectionCounts counts;
  calibration::CameraStatistics statistics;
};

struct StageTime {
  Stage stage = Stage::kDetect;
  int camera_index = -1;
  double seconds = 0.0;  ///< wall time
};

/// A calibration and everything that files, terminal and report tell about it.
struct CalibrationResult {
  target::Target target;
  std::vector<CameraReport> cameras;
  calibration::Solution solution;  ///< rig, and the views that took part with their poses
  /// Seen, but out of the solve (too few tags, or no pose explains them), by camera, then stamp; Corner::used is false.
  std::vector<observation::CameraView> unused_images;
  calibration::CameraGraph graph;  ///< of all synchronised views
  int num_dropped_views = 0;       ///< synchronised views that nothing explains; their images are in unused_images
  std::vector<RoundSummary> rounds;
  std::vector<std::string> warnings;
  std::vector<StageTime> times;  ///< in the order in which the stages ended
};

/// Told what happens while it happens, always on the thread that called. Any member may stay empty.
struct Listener {
  std::function<void(const Progress&)> progress;
  std::function<void(int camera_index, const CameraCorners&)> camera_detected;
  std::function<void(int camera_index, const camera::Camera&)> camera_started;
  std::function<void(const calibration::Problem&)> rig_started;
  std::function<void(const CalibrationResult&)> detection_solved;  ///< what comes out where there are no rounds
  std::function<void(const RoundSummary&)> round_finished;
  std::function<void(const std::string&)> warning;  ///< the same texts are in CalibrationResult::warnings
  std::function<bool()> is_cancelled;               ///< asked once per image, stage and iteration of the solve
};

/// The listener asked to stop.
class Cancelled : public Error {
 public:
  using Error::Error;
};

/// Corners of all images of one camera, detected on options.num_threads threads. Images are streamed: only a few per thread
/// exist at a time. The result does not depend on the number of threads.
CameraCorners detectCorners(const CameraStream& stream, int camera_index, const target::Target& target,
                            const CalibrateOptions& options, const Listener& listener = {});

/// Images to calibration. Throws InputError for options that do not fit the streams, CalibrationError where the images do
/// not determine a result, Cancelled where the listener stopped it.
CalibrationResult calibrate(const std::vector<CameraStream>& streams, const target::Target& target,
                            const CalibrateOptions& options, const Listener& listener = {});

/// What the cameras saw, with Corner::used as the solve left it: what a corners file stores.
std::vector<CameraCorners> observedCorners(const CalibrationResult& result);

/// The same from corners. Corner::used of the input is not looked at.
CalibrationResult calibrateCorners(const std::vector<CameraCorners>& cameras, const target::Target& target,
                                   const CalibrateOptions& options, const Listener& listener = {});

}  // namespace tartan_calib::pipeline
