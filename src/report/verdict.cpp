#include "tartan_calib/report/verdict.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "tartan_calib/pipeline/richer_models.h"
#include "tartan_calib/pipeline/warnings.h"
#include "tartan_calib/text.h"

namespace tartan_calib::report {
namespace {

constexpr double kDegreesPerRadian = 180.0 / M_PI;
constexpr double kNsPerMs = 1e6;

/// From which value on a measure is a reason: not quite good, or to be repeated.
struct Limits {
  double usable = 0.0;
  double repeat = 0.0;
};

constexpr Limits kExtrapolated_ratio = {0.05, 0.4};  ///< of the image
constexpr Limits kFocalStdev_ratio = {0.003, 0.03};
constexpr Limits kStdev_px = {0.3, 2.0};  ///< median over the image of the projection's uncertainty
constexpr Limits kRms_px = {0.6, 1.5};    ///< real lenses and boards reach 0.1 to 0.4
constexpr Limits kRejected_ratio = {0.05, 0.4};
constexpr Limits kBias_px = {0.03, 1.0};
constexpr Limits kDifference_px = {0.1, 1.0};
constexpr Limits kTimingMotion_px = {0.1, 1.0};
constexpr int kFewViews = 10;
constexpr int kTooFewViews = 4;
constexpr int kFewSharedViews = 5;

/// From how many rejected corners on beyond the farthest used one, and from which share of all rejected ones, the board was
/// there and the model is to blame: single wrong corners are anywhere, those of blurred views all over the image.
constexpr int kManyBeyond = 20;
constexpr double kManyBeyond_ratio = 0.2;

/// Two calibrations differ by about the stdev that their uncertainties leave. Beyond this many times that, something else
/// than noise is at work.
constexpr double kMaxDifference_ratio = 4.0;
constexpr double kSignificance = 6.0;  ///< in stdevs
constexpr double kMinBiasOfRms = 0.3;  ///< a pattern smaller than this share of the residuals hardly moves a model
constexpr double kMinDelay_ns = 0.2e6;
constexpr double kShown_px = 0.0005;  ///< what is not 0.000 with three decimals

/// Collects the reasons that one camera gives.
class CameraJudge {
 public:
  CameraJudge(const pipeline::CalibrationResult& result, const Analysis& analysis, std::size_t index,
              std::vector<Reason>& reasons)
      : result_(result),
        camera_(result.solution.rig.cameras[index].camera),
        statistics_(result.cameras[index].statistics),
        counts_(result.solution.counts[index]),
        analysis_(analysis.cameras[index]),
        index_(static_cast<int>(index)),
        name_(cameraName(index)),
        reasons_(reasons) {}

  void judge() {
    checkViews();
    checkReach();
    checkRegions();
    checkUncertainty();
    checkResiduals();
    checkPattern();
    checkHalves();
  }

  std::string fact() const {
    const double stdev_px = analysis_.median_stdev_px;
    return name_ + format(": corners to %.0f degrees from the axis, rms %.3f px, projection certain to %s px (median)",
                          statistics_.max_polar_angle_rad * kDegreesPerRadian, statistics_.rms_px,
                          stdev_px < kShown_px ? "better than 0.001" : format("%.3f", stdev_px).c_str());
  }

 private:
  void add(const Limits& limits, double value, const std::string& text, const std::optional<std::string>& warning = {}) {
    if (value > limits.usable) {
      const Grade grade = value > limits.repeat ? Grade::kRepeat : Grade::kUsable;
      reasons_.push_back({grade, name_ + ": " + text, warning.value_or("")});
    }
  }

  void checkViews() {
    if (statistics_.num_views < kFewViews) {
      reasons_.push_back({statistics_.num_views < kTooFewViews ? Grade::kRepeat : Grade::kUsable,
                          name_ + format(": only %d views: record 30 or more", statistics_.num_views),
                          pipeline::fewViewsWarning(result_, index_).value_or("")});
    }
  }

  void checkReach() {
    const double end_deg = statistics_.max_polar_angle_rad * kDegreesPerRadian;
    const double percent = 100.0 * analysis_.extrapolated_ratio;
    const double reach_deg = analysis_.reach_rad * kDegreesPerRadian;
    const int num_beyond = rejectedBeyondReach();
    if (num_beyond >= std::max<double>(kManyBeyond, kManyBeyond_ratio * counts_.rejected())) {
      const std::string model = camera::modelName(camera_.model);
      add(kExtrapolated_ratio, analysis_.extrapolated_ratio,
          format("all %d corners beyond %.0f degrees from the axis were rejected, where %.0f %% of the image lies (to %.0f "
                 "degrees): %s does not follow the lens there, %s",
                 num_beyond, end_deg, percent, reach_deg, model.c_str(), pipeline::richerModels(model).c_str()));
      return;
    }
    add(kExtrapolated_ratio, analysis_.extrapolated_ratio,
        format("no corner beyond %.0f degrees from the axis, where %.0f %% of the image lies (to %.0f degrees): the edge is "
               "extrapolated; hold the board there",
               end_deg, percent, reach_deg));
  }

  /// Corners farther from the axis than all used ones, or where the model has no ray.
  int rejectedBeyondReach() const {
    const std::vector<FoundCorner>& found = analysis_.corners.found;
    return static_cast<int>(std::count_if(found.begin(), found.end(), [this](const FoundCorner& corner) {
      return !corner.used && (!corner.polar_rad || *corner.polar_rad > statistics_.max_polar_angle_rad);
    }));
  }

  void checkRegions() {
    if (!analysis_.empty_regions.empty()) {
      reasons_.push_back({Grade::kUsable, name_ + ": no corner in these parts of the image: " +
                                              joined(analysis_.empty_regions) + "; hold the board there"});
    }
  }

  void checkUncertainty() {
    add(kFocalStdev_ratio, analysis_.focal_stdev_ratio,
        format("views too similar: focal length uncertain to %.1f %%; tilt the board to 45 degrees, hold it near and far",
               100.0 * analysis_.focal_stdev_ratio));
    // The covariance grows with the residuals, so that of a model that cannot follow the lens need not be the views' doing.
    if (pattern() == nullptr || analysis_.median_stdev_px > statistics_.rms_px) {
      add(kStdev_px, analysis_.median_stdev_px,
          format("too little data: the projection is uncertain to %.1f px (median over the image); record more views, close "
                 "up",
                 analysis_.median_stdev_px));
    }
  }

  void checkResiduals() {
    add(kRms_px, statistics_.rms_px,
        format("large residuals (rms %.2f px): look for motion blur, wrong sizes in the target file, a bent board, a "
               "rolling shutter, or a model that cannot follow the lens",
               statistics_.rms_px),
        pipeline::largeResidualsWarning(result_, index_));
    const double ratio = static_cast<double>(counts_.rejected()) / std::max(1, counts_.rejected() + counts_.used);
    add(kRejected_ratio, ratio,
        format("%.0f %% of the corners were rejected (%d outliers, %d that the model cannot project): look at the worst "
               "frames%s",
               100.0 * ratio, counts_.outliers, counts_.unprojectable,
               result_.cameras.size() > 1 ? ", and check the cameras' sync (inspect_bag)" : ""),
        pipeline::rejectedCornersWarning(result_, index_));
  }

  /// The largest of the residuals that point the same way at the same angle, which are no noise: the model cannot follow the
  /// lens. Null where there are none.
  const RadialBias* pattern() const {
    const auto size = [](const RadialBias& bias) { return std::abs(bias.mean_px); };
    const RadialBias* worst = nullptr;
    for (const RadialBias& bias : analysis_.radial_biases) {
      const bool is_significant = bias.num_images >= kTooFewViews && size(bias) > kSignificance * bias.stdev_px &&
                                  size(bias) > kMinBiasOfRms * statistics_.rms_px && size(bias) > kBias_px.usable;
      if (is_significant && (worst == nullptr || size(bias) > size(*worst))) {
        worst = &bias;
      }
    }
    return worst;
  }

  void checkPattern() {
    const RadialBias* bias = pattern();
    if (bias == nullptr) {
      return;
    }
    const double size_px = std::abs(bias->mean_px);
    const std::string model = camera::modelName(camera_.model);
    add(kBias_px, size_px,
        format(
            "residuals follow the angle (%.2f px %s on average at %.0f to %.0f degrees): %s is too simple for this lens, %s",
            size_px, bias->mean_px > 0.0 ? "outwards" : "inwards", bias->from_rad * kDegreesPerRadian,
            bias->to_rad * kDegreesPerRadian, model.c_str(), pipeline::richerModels(model).c_str()));
  }

  void checkHalves() {
    if (!analysis_.median_difference_px) {
      return;
    }
    const double expected_px = analysis_.median_expected_difference_px;
    if (*analysis_.median_difference_px > kMaxDifference_ratio * expected_px) {
      add(kDifference_px, *analysis_.median_difference_px,
          format("even and odd views give calibrations %.2f px apart, %.0f times what noise explains: look for motion blur, "
                 "a rolling shutter, a bent board, or a camera that changed",
                 *analysis_.median_difference_px, *analysis_.median_difference_px / expected_px));
    }
  }

  const pipeline::CalibrationResult& result_;
  const camera::Camera& camera_;
  const calibration::CameraStatistics& statistics_;
  const calibration::CornerCounts& counts_;
  const CameraAnalysis& analysis_;
  const int index_;
  const std::string name_;
  std::vector<Reason>& reasons_;
};

void judgeTiming(const CameraTiming& timing, std::vector<Reason>& reasons) {
  const double delay_ms = timing.delay_ns / kNsPerMs;
  const double stamps_ms = timing.median_stamp_ns / kNsPerMs;
  const double motion_px = std::abs(delay_ms) * timing.speed_px_per_ms;
  const bool is_significant = std::abs(timing.delay_ns) > kSignificance * timing.delay_stdev_ns &&
                              std::abs(timing.delay_ns) > kMinDelay_ns && timing.num_views >= kFewSharedViews;
  if (!is_significant || motion_px < kTimingMotion_px.usable) {
    return;
  }
  reasons.push_back(
      {motion_px > kTimingMotion_px.repeat ? Grade::kRepeat : Grade::kUsable,
       format("cam%d: stereo pairs %.1f ms apart (their stamps: %.1f ms), in which the board moves by %.1f px: check "
              "sync, or hold the board still",
              timing.camera_index, std::abs(delay_ms), stamps_ms, motion_px)});
}

void judgeRig(const pipeline::CalibrationResult& result, std::vector<Reason>& reasons) {
  const calibration::Solution& solution = result.solution;
  for (const std::string& text : pipeline::solutionWarnings(solution)) {
    reasons.push_back({Grade::kRepeat, text});
  }
  for (Eigen::Index i = 1; i < result.graph.shared_views.rows(); ++i) {
    const int shared = result.graph.shared_views.row(i).head(i).maxCoeff();
    if (shared < kFewSharedViews) {
      reasons.push_back(
          {Grade::kUsable, format("cam%td shares only %d views with any camera before it: its place on the rig "
                                  "stands on little; hold the board where both see it",
                                  i, shared)});
    }
  }
}

}  // namespace

std::string gradeName(Grade grade) {
  switch (grade) {
    case Grade::kGood:
      return "good";
    case Grade::kUsable:
      return "usable";
    case Grade::kRepeat:
      return "repeat";
  }
  return "";
}

Verdict judge(const pipeline::CalibrationResult& result, const Analysis& analysis) {
  Verdict verdict;
  judgeRig(result, verdict.reasons);
  for (std::size_t i = 0; i < analysis.cameras.size(); ++i) {
    CameraJudge judge(result, analysis, i, verdict.reasons);
    judge.judge();
    verdict.facts.push_back(judge.fact());
  }
  for (const CameraTiming& timing : analysis.timings) {
    judgeTiming(timing, verdict.reasons);
  }
  std::stable_sort(verdict.reasons.begin(), verdict.reasons.end(),
                   [](const Reason& a, const Reason& b) { return a.grade > b.grade; });
  if (!verdict.reasons.empty()) {
    verdict.grade = verdict.reasons.front().grade;
  }
  return verdict;
}

}  // namespace tartan_calib::report
