#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tartan_calib/calibration/compare.h"
#include "tartan_calib/io/camchain.h"
#include "tartan_calib/pipeline/calibrate.h"

namespace tartan_calib::apps {

/// Difference of the projections at the pixels whose polar angle in calibration a lies in [from, to).
struct DifferenceBand {
  double from_rad = 0.0;
  double to_rad = 0.0;
  int num_pixels = 0;
  double mean_px = 0.0;
  double rms_px = 0.0;
  double max_px = 0.0;
};

struct CameraComparison {
  calibration::ProjectionDifference projection;
  double mean_px = 0.0;
  std::vector<DifferenceBand> bands;  ///< of 10 degrees
};

/// Size of a rigid motion.
struct MotionSize {
  double rotation_rad = 0.0;
  double translation_m = 0.0;
};

/// How far camera `second` sits elsewhere, seen from camera `first`.
struct PairComparison {
  int first = 0;
  int second = 1;
  MotionSize difference;  ///< of the two T_second_first
  /// The same after the motions between the camera frames, which the projections' comparison finds: what lens and place on
  /// the rig can take over from each other is not counted.
  MotionSize difference_without_frames;
};

struct RigComparison {
  std::vector<CameraComparison> cameras;
  std::vector<PairComparison> pairs;  ///< every two cameras
};

/// Which pixels of calibration a are compared.
struct ComparisonRegion {
  double max_angle_rad = 1.5707963267948966;  ///< from the axis
  std::optional<double> distance_m;           ///< of the points that are compared; empty: infinity
  /// Where given, only around pixels near which every one of these recordings has a corner.
  std::vector<std::vector<pipeline::CameraCorners>> recordings;
};

constexpr double kSampleSpacing_px = 10.0;  ///< of the grid of pixels that are compared

/// Camera by camera. Throws InputError where the rigs, their images or the recordings do not fit each other.
RigComparison compareRigs(const calibration::Rig& a, const calibration::Rig& b, const ComparisonRegion& region);

/// For people: parameters side by side where the models are the same, then the comparison.
std::string comparisonText(const io::Camchain& a, const io::Camchain& b, const ComparisonRegion& region,
                           const RigComparison& comparison);

}  // namespace tartan_calib::apps
