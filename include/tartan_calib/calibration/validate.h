#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

#include "tartan_calib/calibration/rig.h"
#include "tartan_calib/geometry/rigid3.h"
#include "tartan_calib/observation/observation.h"

namespace tartan_calib::calibration {

/// A corner against the calibration that predicts it.
struct CornerError {
  int corner_id = -1;
  Eigen::Vector2d px = Eigen::Vector2d::Zero();        ///< measured
  Eigen::Vector2d error_px = Eigen::Vector2d::Zero();  ///< measured minus predicted
  double polar_rad = 0.0;                              ///< of the predicted ray, from the optical axis
  /// Far off while its neighbours on the board are not: a corner that was detected wrongly, since a lens that is calibrated
  /// wrongly moves all of them. Statistics count such corners and leave them out.
  bool is_wrong = false;
};

/// The corners of one image against one pose of the board.
struct ImageErrors {
  int camera_index = 0;
  std::int64_t stamp_ns = 0;
  geometry::Rigid3 T_cam_target;
  std::vector<CornerError> corners;  ///< by increasing corner_id
  int num_unprojectable = 0;         ///< corners to which the model gives no image at this pose
};

/// What one synchronous view of a board says about a calibration that stays as it is.
struct ViewErrors {
  std::int64_t stamp_ns = 0;
  /// By increasing camera_index, with one T_rig_target for all cameras: intrinsics and extrinsics together. Empty where no
  /// pose explains the view.
  std::vector<ImageErrors> together;
  /// The same with the pose that suits each camera best: the intrinsics alone. Cameras without a pose are absent.
  std::vector<ImageErrors> alone;
};

/// Estimates the board's pose, and nothing else, by robust least squares and measures how far every corner is from where the
/// calibration puts it. `target_points`: [m], by corner id. Corner::used is not looked at. Takes milliseconds and may be
/// called from several threads.
ViewErrors validateView(const Rig& rig, const std::vector<Eigen::Vector3d>& target_points, const observation::View& view);

/// Sizes of corner errors. |e| of all corners that are not wrong.
struct ErrorSummary {
  int num_corners = 0;
  Eigen::Vector2d mean_px = Eigen::Vector2d::Zero();  ///< of the errors, per axis: 0 where nothing pulls to one side
  double rms_px = 0.0;                                ///< sqrt(mean |e|^2)
  double median_px = 0.0;
  double percentile95_px = 0.0;
  double max_px = 0.0;
};

/// Of the corners whose polar angle lies in [from, to).
struct ErrorBand {
  double from_rad = 0.0;
  double to_rad = 0.0;
  ErrorSummary errors;
};

struct CameraErrors {
  int num_images = 0;
  int num_wrong = 0;
  int num_unprojectable = 0;
  double max_polar_rad = 0.0;
  ErrorSummary errors;
  std::vector<ErrorBand> bands;  ///< of 10 degrees, up to max_polar_rad
};

/// Of all images of one camera.
CameraErrors summarizeErrors(const std::vector<ImageErrors>& images);

/// Of one image, or of any other corners.
ErrorSummary summarizeCorners(const std::vector<CornerError>& corners);

}  // namespace tartan_calib::calibration
