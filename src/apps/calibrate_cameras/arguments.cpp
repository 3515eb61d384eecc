#include "calibrate_cameras/arguments.h"

#include <array>
#include <cmath>
#include <cstdlib>

#include "calibrate_cameras/flags.h"
#include "calibrate_cameras/projection_flags.h"
#include "calibrate_cameras/refinement_flags.h"
#include "calibrate_cameras/rig_file.h"
#include "common/program.h"
#include "common/recording.h"
#include "tartan_calib/text.h"

namespace tartan_calib::apps {
namespace {

using Words = std::vector<std::string>;

calibration::LinearSolver linearSolver(const std::string& name) {
  if (name == "schur") {
    return calibration::LinearSolver::kSchur;
  }
  if (name == "sparse") {
    return calibration::LinearSolver::kSparse;
  }
  if (name != "auto") {
    throw UsageError("--linear-solver is schur, sparse or auto, not '" + name + "'");
  }
  return calibration::LinearSolver::kAuto;
}

void applyCornerFilter(const Flags& flags, detection::RecoveryOptions& recovery) {
  const auto name = flags.get<std::string>("corner-filter", "image");
  if (name != "image" && name != "quads") {
    throw UsageError("--corner-filter is image or quads, not '" + name + "'");
  }
  recovery.filter = name == "quads" ? detection::CornerFilter::kQuads : detection::CornerFilter::kImage;
  if (flags.has("correction-threshold") && name != "quads") {
    throw UsageError("--correction-threshold needs --corner-filter quads");
  }
  recovery.max_quad_distance_px = flags.get("correction-threshold", recovery.max_quad_distance_px);
  if (!(recovery.max_quad_distance_px > 0.0)) {
    throw UsageError("--correction-threshold must be a positive number of pixels");
  }
}

/// Index of `camN`; empty for any other word.
std::optional<int> cameraIndex(const std::string& word) {
  constexpr std::size_t kMaxDigits = 3;
  const std::string digits = word.compare(0, 3, "cam") == 0 ? word.substr(3) : "";
  const bool is_index =
      !digits.empty() && digits.size() <= kMaxDigits && digits.find_first_not_of("0123456789") == std::string::npos;
  return is_index ? std::make_optional(std::stoi(digits)) : std::nullopt;
}

void applyFix(const Words& parts, calibration::SolveOptions& solve) {
  for (const std::string& part : parts) {
    if (part == "intrinsics") {
      solve.fix_intrinsics = true;
    } else if (part == "extrinsics") {
      solve.fix_extrinsics = true;
    } else if (const std::optional<int> index = cameraIndex(part)) {
      solve.fixed_cameras.push_back(*index);
    } else {
      throw UsageError("--fix takes intrinsics, extrinsics or a camera such as cam1, not '" + part + "'");
    }
  }
}

void applyFilters(const Flags& flags, pipeline::CalibrateOptions& options) {
  detection::DetectorOptions& detector = options.detector;
  detector.min_border_distance_px = flags.get("min-border-distance", detector.min_border_distance_px);
  if (!(detector.min_border_distance_px >= 0.0)) {
    throw UsageError("--min-border-distance must be a number of pixels, not negative");
  }
  if (flags.has("min-tags")) {
    options.min_tags = flags.get<int>("min-tags");
    if (*options.min_tags < 1) {
      throw UsageError("--min-tags must be a positive integer");
    }
  }
}

pipeline::CalibrateOptions calibrateFrom(const Flags& flags) {
  constexpr double kNsPerSecond = 1e9;
  constexpr double kMaxSync_s = 1e6;
  pipeline::CalibrateOptions options;
  options.models = flags.get<Words>("models");
  const double sync_s = flags.get("approx-sync", static_cast<double>(options.approx_sync_ns) / kNsPerSecond);
  if (!(sync_s >= 0.0 && sync_s <= kMaxSync_s)) {
    throw UsageError("--approx-sync must be a number of seconds, not negative");
  }
  options.approx_sync_ns = std::llround(sync_s * kNsPerSecond);
  options.num_threads = flags.get("threads", options.num_threads);
  if (options.num_threads < 0) {
    throw UsageError("--threads must not be negative; 0 uses all cores");
  }
  calibration::SolveOptions& solve = options.solve;
  solve.remove_outliers = !flags.has("no-outliers-removal");
  solve.final_filtering = !flags.has("no-final-filtering");
  solve.use_blake_zisserman = flags.has("use-blakezisserman");
  solve.estimate_board_warp = flags.has("estimate-board-warp");
  solve.estimate_pupil_shift = flags.has("estimate-pupil-shift");
  solve.min_views_outlier = flags.get("min-views-outlier", solve.min_views_outlier);
  if (solve.min_views_outlier < 1) {
    throw UsageError("--min-views-outlier must be a positive integer");
  }
  options.max_rounds = flags.get("max-rounds", options.max_rounds);
  if (options.max_rounds < 0) {
    throw UsageError("--max-rounds must not be negative; 0 leaves the rounds out");
  }
  options.projections = projectionsFrom(flags);
  applyFilters(flags, options);
  applyCornerFilter(flags, options.recovery);
  applyRefinement(flags, options.recovery);
  solve.linear_solver = linearSolver(flags.get<std::string>("linear-solver", "auto"));
  applyFix(flags.get<Words>("fix"), solve);
  return options;
}

/// Names flags that say what to do with images where there are none.
void noteFlagsOfImages(const Flags& flags, Words& notes) {
  constexpr std::array kFlagsOfImages = {"bag-from-to",
                                         "bag-freq",
                                         "max-rounds",
                                         "min-border-distance",
                                         "corner-filter",
                                         "correction-threshold",
                                         "projections",
                                         "fovs",
                                         "poses",
                                         "resolutions",
                                         "refinement",
                                         "symmetry-window",
                                         "window-scale",
                                         "min-resize-window-size",
                                         "max-resize-window-size"};
  Words unused;
  for (const std::string flag : kFlagsOfImages) {
    if (flags.has(flag)) {
      unused.push_back("--" + flag);
    }
  }
  if (!unused.empty()) {
    notes.push_back(joined(unused) + (unused.size() == 1 ? " has" : " have") + " no effect: --corners brings no images");
  }
}

void checkComplete(const Arguments& arguments, const Flags& flags) {
  const bool has_corners = !arguments.corners_file.empty();
  const bool has_init = !arguments.init_file.empty();
  const auto require = [](bool is_there, const std::string& what) {
    if (!is_there) {
      throw UsageError(what + "; see --help");
    }
  };
  require(!arguments.target_file.empty(), "--target is missing: the YAML file of the board");
  require(!arguments.recording.empty() || has_corners, "--bag is missing: a ROS bag or a folder with images");
  require(!arguments.topics.empty() || has_corners || has_init, "--topics is missing: the image topics in the bag");
  require(!arguments.calibrate.models.empty() || has_init, "--models is missing: one camera model per topic");
  require(!flags.has("fix") || has_init, "--fix needs --init, the calibration to keep parts of");
  const std::size_t num_models = arguments.calibrate.models.size();
  const std::size_t num_topics = arguments.topics.size();
  require(num_models == num_topics || num_models == 0 || num_topics == 0,
          "exactly one camera model per topic is needed: --models has " + std::to_string(num_models) + ", --topics has " +
              std::to_string(num_topics));
}

}  // namespace

Arguments parseArguments(const std::vector<std::string>& words) {
  const Flags flags = parseFlags(withRigFile(withFullNames(words)));
  if (flags.has("rig")) {
    throw UsageError("--rig is there twice, or stands in a rig file: one file holds all flags of a rig");
  }
  Arguments arguments;
  arguments.help = flags.has("help");
  if (arguments.help) {
    return arguments;
  }
  arguments.verbose = flags.has("verbose");
  arguments.recording = flags.get<std::string>("bag");
  arguments.corners_file = flags.get<std::string>("corners");
  arguments.topics = flags.get<Words>("topics");
  arguments.target_file = flags.get<std::string>("target");
  arguments.init_file = flags.get<std::string>("init");
  arguments.selection = selectionFrom(flags.values());
  arguments.calibrate = calibrateFrom(flags);
  arguments.export_poses = flags.has("export-poses");
  arguments.export_corners = flags.has("export-corners");
  arguments.report = !flags.has("no-report");
  arguments.show_report = !flags.has("dont-show-report");
  checkComplete(arguments, flags);
  if (arguments.corners_file.empty()) {
    arguments.notes = notesOnProjections(flags);
  } else {
    noteFlagsOfImages(flags, arguments.notes);
  }
  return arguments;
}

std::optional<double> focalHint(const char* value) {
  constexpr double kMinFocal_px = 10.0;
  constexpr double kMaxFocal_px = 1e6;
  if (value == nullptr) {
    return std::nullopt;
  }
  char* end = nullptr;
  const double focal_px = std::strtod(value, &end);
  const bool is_number = end != value && *end == '\0';
  return is_number && focal_px > kMinFocal_px && focal_px < kMaxFocal_px ? std::make_optional(focal_px) : std::nullopt;
}

}  // namespace tartan_calib::apps
