#include <algorithm>
#include <cmath>

#include "tartan_calib/text.h"
#include "validate_calibration/validation.h"

namespace tartan_calib::apps {
namespace {

using calibration::CameraErrors;
using calibration::ErrorSummary;
using calibration::ImageErrors;

constexpr double kDegreesPerRadian = 57.29577951308232;
constexpr long long kNsPerSecond = 1'000'000'000;

/// Another recording is sharper or more blurred than the calibration's by so much at most, where both were made with care.
constexpr double kUsualRatio = 1.5;
constexpr double kFailRatio = 3.0;
/// A band of angles is told of where its rms is so many times the camera's, over three tags' corners at least.
constexpr double kBandRatio = 2.0;
constexpr int kBandCorners = 12;
constexpr int kFewViews = 10;
/// Share of corners that are wrong with a good detector, or without an image with a usable lens, at most; and of views
/// without a pose.
constexpr double kManyLost = 0.02;

std::string summaryText(const ErrorSummary& errors) {
  return format("%9d %8.4f %8.4f %8.4f %8.4f", errors.num_corners, errors.rms_px, errors.median_px, errors.percentile95_px,
                errors.max_px);
}

std::string cameraText(const CameraValidation& camera, int camera_index, bool is_rig) {
  std::string text =
      format("%s (%s), %s: board in %d of %zu images\n", cameraName(camera_index).c_str(), camera.topic.c_str(),
             camera::modelName(camera.camera.model).c_str(), camera.together.num_images, camera.num_images);
  text += format("  %-24s%9s %8s %8s %8s %8s\n", "errors [px]", "corners", "rms", "median", "95 %", "max");
  text += format("  %-24s%s\n", is_rig ? "one pose for the rig" : "all", summaryText(camera.together.errors).c_str());
  if (is_rig) {
    text += format("  %-24s%s\n", "this camera alone", summaryText(camera.alone.errors).c_str());
  }
  for (const calibration::ErrorBand& band : camera.together.bands) {
    if (band.errors.num_corners > 0) {
      const std::string degrees =
          format("%.0f to %.0f degrees", band.from_rad * kDegreesPerRadian, band.to_rad * kDegreesPerRadian);
      text += format("  %-24s%s\n", degrees.c_str(), summaryText(band.errors).c_str());
    }
  }
  const Eigen::Vector2d& mean_px = camera.together.errors.mean_px;
  text += format("  mean error (%.4f, %.4f) px", mean_px.x(), mean_px.y());
  text += format("; left out: %d corners detected wrongly, %d without an image\n", camera.together.num_wrong,
                 camera.together.num_unprojectable);
  return text;
}

std::string worstViewsText(const Validation& validation) {
  constexpr std::size_t kNumWorst = 5;
  struct Entry {
    ErrorSummary errors;
    const ImageErrors* image;
  };
  std::vector<Entry> entries;
  for (const CameraValidation& camera : validation.cameras) {
    for (const ImageErrors& image : camera.images) {
      entries.push_back({calibration::summarizeCorners(image.corners), &image});
    }
  }
  const auto count = static_cast<std::ptrdiff_t>(std::min(kNumWorst, entries.size()));
  std::partial_sort(entries.begin(), entries.begin() + count, entries.end(),
                    [](const Entry& a, const Entry& b) { return a.errors.rms_px > b.errors.rms_px; });
  std::string text = "worst images\n";
  for (auto entry = entries.begin(); entry != entries.begin() + count; ++entry) {
    const long long stamp_ns = entry->image->stamp_ns;
    text += format("  %s at %lld.%09lld s: rms %.4f px, %d corners\n", cameraName(entry->image->camera_index).c_str(),
                   stamp_ns / kNsPerSecond, stamp_ns % kNsPerSecond, entry->errors.rms_px, entry->errors.num_corners);
  }
  return text;
}

/// How the errors compare with those of the calibration itself.
Fit fitOf(const CameraValidation& camera) {
  if (!camera.expected_px || camera.together.errors.num_corners == 0) {
    return Fit::kUnknown;
  }
  const double ratio = camera.together.errors.rms_px / *camera.expected_px;
  return ratio > kFailRatio ? Fit::kFails : ratio > kUsualRatio ? Fit::kDoubtful : Fit::kHolds;
}

void addWorstBand(const CameraErrors& errors, const std::string& name, std::vector<std::string>& reasons) {
  const calibration::ErrorBand* worst = nullptr;
  for (const calibration::ErrorBand& band : errors.bands) {
    const bool is_known = band.errors.num_corners >= kBandCorners;
    if (is_known && (worst == nullptr || band.errors.rms_px > worst->errors.rms_px)) {
      worst = &band;
    }
  }
  if (worst != nullptr && worst->errors.rms_px > kBandRatio * errors.errors.rms_px) {
    reasons.push_back(format("%s: largest from %.0f to %.0f degrees from the axis: rms %.4f px of %d corners", name.c_str(),
                             worst->from_rad * kDegreesPerRadian, worst->to_rad * kDegreesPerRadian, worst->errors.rms_px,
                             worst->errors.num_corners));
  }
}

void addReasons(const CameraValidation& camera, const std::string& name, std::vector<std::string>& reasons) {
  const CameraErrors& together = camera.together;
  const double rms_px = together.errors.rms_px;
  if (camera.expected_px && fitOf(camera) != Fit::kUnknown) {
    reasons.push_back(format("%s: rms %.4f px, %.1f times the %.4f px that are expected", name.c_str(), rms_px,
                             rms_px / *camera.expected_px, *camera.expected_px));
  }
  if (rms_px > kUsualRatio * camera.alone.errors.rms_px && camera.alone.errors.num_corners > 0) {
    reasons.push_back(
        format("%s: rms %.4f px with one pose for the rig, %.4f px alone: its place on the rig has changed, or the "
               "cameras are not triggered together",
               name.c_str(), rms_px, camera.alone.errors.rms_px));
  }
  addWorstBand(together, name, reasons);
  const double num_lost = kManyLost * (together.num_wrong + together.num_unprojectable + together.errors.num_corners);
  if (together.num_wrong > num_lost) {
    reasons.push_back(format("%s: %d corners do not fit those beside them: is the board flat, and the shutter global?",
                             name.c_str(), together.num_wrong));
  }
  if (together.num_unprojectable > num_lost) {
    reasons.push_back(
        format("%s: the model has no image for %d corners that were seen", name.c_str(), together.num_unprojectable));
  }
  if (together.num_images < kFewViews) {
    reasons.push_back(format("%s: only %d images show the board: little is tested", name.c_str(), together.num_images));
  }
  reasons.push_back(
      format("%s: tested to %.0f degrees from the axis", name.c_str(), together.max_polar_rad * kDegreesPerRadian));
}

std::string fitText(Fit fit) {
  switch (fit) {
    case Fit::kHolds:
      return "the calibration holds";
    case Fit::kDoubtful:
      return "doubtful";
    case Fit::kFails:
      return "the calibration does not hold";
    case Fit::kUnknown:
      break;
  }
  return "none: what to expect is not known; give --expected-px, or keep the calibration's -results-cam.txt beside the "
         "camchain";
}

}  // namespace

Judgement judge(const Validation& validation) {
  Judgement judgement;
  const auto severity = [](Fit fit) { return fit == Fit::kUnknown ? -1 : static_cast<int>(fit); };
  for (std::size_t i = 0; i < validation.cameras.size(); ++i) {
    const Fit fit = fitOf(validation.cameras[i]);
    if (severity(fit) > severity(judgement.fit)) {
      judgement.fit = fit;
    }
    addReasons(validation.cameras[i], cameraName(i), judgement.reasons);
  }
  if (static_cast<double>(validation.num_unexplained) > kManyLost * static_cast<double>(validation.num_views)) {
    judgement.reasons.push_back(
        format("no pose of the board explains %zu of %zu views", validation.num_unexplained, validation.num_views));
  }
  if (validation.cameras.size() > 1 && validation.num_joint == 0) {
    judgement.reasons.emplace_back(
        "no two cameras saw the board at the same time: the extrinsics are not tested; see --approx-sync");
  }
  return judgement;
}

std::string validationText(const Validation& validation) {
  std::string text;
  const bool is_rig = validation.cameras.size() > 1;
  for (std::size_t i = 0; i < validation.cameras.size(); ++i) {
    text += cameraText(validation.cameras[i], static_cast<int>(i), is_rig);
  }
  text += format("%zu views, %zu of several cameras, %zu that no pose explains\n", validation.num_views,
                 validation.num_joint, validation.num_unexplained);
  text += worstViewsText(validation);
  const Judgement judgement = judge(validation);
  text += "\nVerdict: " + fitText(judgement.fit) + "\n";
  for (const std::string& reason : judgement.reasons) {
    text += "  " + reason + "\n";
  }
  return text;
}

}  // namespace tartan_calib::apps
