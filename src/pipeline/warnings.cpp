#include "tartan_calib/pipeline/warnings.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "tartan_calib/text.h"

namespace tartan_calib::pipeline {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kDegreesPerRadian = 180.0 / kPi;

/// Below these a calibration stands on little; 20 to 30 views are usual.
constexpr int kFewViews = 10;
constexpr int kFewCorners = 600;
/// Distance of the principal point from the image centre, over the image's width or height, above which a lens is unusual
/// and a weak geometry of the views more likely.
constexpr double kFarPrincipalPoint_ratio = 0.15;
/// Share of the cells of a grid over the image that hold a corner. A circular fisheye fills about 0.6 of a 4:3 image.
constexpr double kPoorCoverage_ratio = 0.35;
constexpr int kCoverageCells = 10;  ///< per row and column
/// Share of rejected corners above which something is wrong besides single corners.
constexpr double kManyOutliers_ratio = 0.05;
/// No lens that its model fits leaves so much.
constexpr double kLargeRms_px = 1.0;

double coverage(const CalibrationResult& result, int camera_index) {
  const camera::Camera& camera = result.solution.rig.cameras[static_cast<std::size_t>(camera_index)].camera;
  std::array<bool, kCoverageCells * kCoverageCells> cells{};
  const auto cell = [](double px, int size) {
    return std::clamp(static_cast<int>((px + 0.5) / size * kCoverageCells), 0, kCoverageCells - 1);
  };
  for (const observation::View& view : result.solution.views) {
    for (const observation::CameraView& image : view.cameras) {
      for (const observation::Corner& corner : image.corners) {
        if (image.camera_index == camera_index && corner.used) {
          const int row = cell(corner.px.y(), camera.height);
          cells[static_cast<std::size_t>(row * kCoverageCells + cell(corner.px.x(), camera.width))] = true;
        }
      }
    }
  }
  return static_cast<double>(std::count(cells.begin(), cells.end(), true)) / static_cast<double>(cells.size());
}

/// Collects the warnings about one camera.
class CameraWarnings {
 public:
  CameraWarnings(const CalibrationResult& result, int camera_index)
      : result_(result),
        index_(camera_index),
        statistics_(result.cameras[static_cast<std::size_t>(camera_index)].statistics),
        camera_(result.solution.rig.cameras[static_cast<std::size_t>(camera_index)].camera) {}

  std::vector<std::string> collect() {
    add(fewViewsWarning(result_, index_));
    checkCoverage();
    add(largeResidualsWarning(result_, index_));
    add(rejectedCornersWarning(result_, index_));
    checkPrincipalPoint();
    checkKalibrLimits();
    add(hemisphereNote(result_, index_));
    add(pupilNote(result_, index_));
    return std::move(warnings_);
  }

 private:
  void add(const std::string& text) { warnings_.push_back(cameraName(index_) + ": " + text); }

  void add(const std::optional<std::string>& warning) {
    if (warning) {
      warnings_.push_back(*warning);
    }
  }

  void checkCoverage() {
    const double covered = coverage(result_, index_);
    if (covered < kPoorCoverage_ratio) {
      add(format("corners cover only %.0f %% of the image; elsewhere the model is extrapolated: move the board to the edges",
                 100.0 * covered));
    }
  }

  void checkPrincipalPoint() {
    const Eigen::Vector2d px = principalPoint();
    const double off_x = std::abs(px.x() - 0.5 * (camera_.width - 1)) / camera_.width;
    const double off_y = std::abs(px.y() - 0.5 * (camera_.height - 1)) / camera_.height;
    if (std::max(off_x, off_y) > kFarPrincipalPoint_ratio) {
      add(format("the principal point (%.1f, %.1f) is far from the centre of the %dx%d image", px.x(), px.y(), camera_.width,
                 camera_.height));
    }
  }

  /// What Kalibr's own writer refuses; its reader has the same limits.
  void checkKalibrLimits() {
    const std::string refused = " is outside of what Kalibr accepts in a camchain";
    const Eigen::VectorXd parameters = camera::parameters(camera_.model);
    const std::string model = camera::kalibrModel(camera_.model);
    if (principalPoint().minCoeff() < 0.0) {
      add("the principal point" + refused);
    }
    if (model == "omni" && parameters(0) < 0.0) {
      add("xi" + refused);
    }
    const bool is_alpha_out = (model == "eucm" && (parameters(0) < 0.0 || parameters(0) >= 1.0)) ||
                              (model == "ds" && (parameters(1) < 0.0 || parameters(1) >= 1.0));
    if (is_alpha_out) {
      add("alpha" + refused);
    }
    if (model == "eucm" && parameters(1) < 0.0) {
      add("beta" + refused);
    }
  }

  Eigen::Vector2d principalPoint() const {
    return camera::parameters(camera_.model).segment<2>(camera::focalIndex(camera_.model) + 2);
  }

  const CalibrationResult& result_;
  const int index_;
  const calibration::CameraStatistics& statistics_;
  const camera::Camera& camera_;
  std::vector<std::string> warnings_;
};

}  // namespace

std::optional<std::string> hemisphereNote(const CalibrationResult& result, int camera_index) {
  const auto at = static_cast<std::size_t>(camera_index);
  const camera::CameraModel& model = result.solution.rig.cameras[at].camera.model;
  const double max_angle_rad = result.cameras[at].statistics.max_polar_angle_rad;
  if (camera::kalibrModel(model) != "pinhole" || max_angle_rad <= 0.5 * kPi) {
    return std::nullopt;
  }
  return cameraName(camera_index) +
         format(
             ": corners to %.1f degrees from the axis were used; %s is on the true angle here, Kalibr and OpenCV stop at 90",
             max_angle_rad * kDegreesPerRadian, camera::modelName(model).c_str());
}

std::optional<std::string> pupilNote(const CalibrationResult& result, int camera_index) {
  const auto at = static_cast<std::size_t>(camera_index);
  const camera::Camera& camera = result.solution.rig.cameras[at].camera;
  if (camera.pupil.isZero()) {
    return std::nullopt;
  }
  const double angle_rad = result.cameras[at].statistics.max_polar_angle_rad;
  return cameraName(camera_index) +
         format(": the entrance pupil moves by %.2f mm from the axis to %.0f degrees; the model alone holds for far points",
                1e3 * camera.pupil.at_m(angle_rad), angle_rad * kDegreesPerRadian);
}

std::optional<std::string> fewViewsWarning(const CalibrationResult& result, int camera_index) {
  const calibration::CameraStatistics& statistics = result.cameras[static_cast<std::size_t>(camera_index)].statistics;
  if (statistics.num_views >= kFewViews && statistics.num_corners >= kFewCorners) {
    return std::nullopt;
  }
  return cameraName(camera_index) +
         format(": only %d views with %d corners: the result is uncertain; record 20 views or more", statistics.num_views,
                statistics.num_corners);
}

std::optional<std::string> largeResidualsWarning(const CalibrationResult& result, int camera_index) {
  const double rms_px = result.cameras[static_cast<std::size_t>(camera_index)].statistics.rms_px;
  if (rms_px <= kLargeRms_px) {
    return std::nullopt;
  }
  return cameraName(camera_index) +
         format(": the residuals are large (rms %.2f px): check the target's sizes, the model and the shutter", rms_px);
}

std::optional<std::string> rejectedCornersWarning(const CalibrationResult& result, int camera_index) {
  const calibration::CornerCounts& counts = result.solution.counts[static_cast<std::size_t>(camera_index)];
  const int num_corners = counts.rejected() + counts.used;
  if (counts.rejected() <= kManyOutliers_ratio * num_corners) {
    return std::nullopt;
  }
  return cameraName(camera_index) +
         format(
             ": %d of %d corners were rejected (%d outliers, %d that the model cannot project, %d in views without support)",
             counts.rejected(), num_corners, counts.outliers, counts.unprojectable, counts.unsupported);
}

std::vector<std::string> solutionWarnings(const calibration::Solution& solution) {
  std::vector<std::string> warnings;
  if (solution.status != calibration::SolveStatus::kConverged) {
    warnings.push_back(
        format("the solver did not converge within %d iterations: the views leave parameters open, or do not fit together; "
               "record more of them, or try one of --models with fewer parameters",
               solution.iterations));
  }
  if (!solution.undetermined.empty()) {
    warnings.push_back("the views do not determine " + joined(solution.undetermined) +
                       ": record the board at more angles and distances");
  }
  return warnings;
}

std::vector<std::string> resultWarnings(const CalibrationResult& result) {
  std::vector<std::string> warnings;
  const auto append = [&warnings](const std::vector<std::string>& more) {
    warnings.insert(warnings.end(), more.begin(), more.end());
  };
  for (std::size_t i = 0; i < result.cameras.size(); ++i) {
    append(CameraWarnings(result, static_cast<int>(i)).collect());
  }
  if (result.num_dropped_views > 0) {
    warnings.push_back(
        format("%d views were left out because no pose of the board explains them", result.num_dropped_views));
  }
  append(solutionWarnings(result.solution));
  return warnings;
}

}  // namespace tartan_calib::pipeline
