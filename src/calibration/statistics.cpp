#include "tartan_calib/calibration/statistics.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tartan_calib::calibration {
namespace {

constexpr double kBandWidth_rad = M_PI / 18.0;

/// The used corners of one camera that the solution gives an image.
struct Errors {
  std::vector<Eigen::Vector2d> errors_px;  ///< measured - predicted
  std::vector<double> polar_angles_rad;
  int num_views = 0;
};

void addImage(const RigCamera& rig_camera, const geometry::Rigid3& T_rig_target, const std::vector<Eigen::Vector3d>& points,
              const observation::CameraView& image, Errors& errors) {
  const geometry::Rigid3 T_cam_target = rig_camera.T_cam_rig * T_rig_target;
  const std::size_t before = errors.errors_px.size();
  for (const observation::Corner& corner : image.corners) {
    const Eigen::Vector3d p_cam = T_cam_target * points[static_cast<std::size_t>(corner.corner_id)];
    const std::optional<Eigen::Vector2d> predicted_px = camera::project(rig_camera.camera, p_cam);
    if (corner.used && predicted_px) {
      errors.errors_px.emplace_back(corner.px - *predicted_px);
      errors.polar_angles_rad.push_back(std::atan2(p_cam.head<2>().norm(), p_cam.z()));
    }
  }
  errors.num_views += errors.errors_px.size() > before ? 1 : 0;
}

std::vector<PolarBand> polarBands(const Errors& errors) {
  std::vector<PolarBand> bands;
  for (std::size_t i = 0; i < errors.errors_px.size(); ++i) {
    const std::size_t band = static_cast<std::size_t>(errors.polar_angles_rad[i] / kBandWidth_rad);
    while (bands.size() <= band) {
      const double from_rad = kBandWidth_rad * static_cast<double>(bands.size());
      bands.push_back({from_rad, from_rad + kBandWidth_rad, 0, 0.0});
    }
    ++bands[band].num_corners;
    bands[band].rms_px += errors.errors_px[i].squaredNorm();
  }
  for (PolarBand& band : bands) {
    band.rms_px = std::sqrt(band.rms_px / std::max(1, band.num_corners));
  }
  return bands;
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  if (values.size() % 2 == 1) {
    return *middle;
  }
  return 0.5 * (*middle + *std::max_element(values.begin(), middle));
}

CameraStatistics statisticsOf(const Errors& errors) {
  CameraStatistics statistics;
  statistics.num_views = errors.num_views;
  statistics.num_corners = static_cast<int>(errors.errors_px.size());
  if (errors.errors_px.empty()) {
    return statistics;
  }
  const double n = static_cast<double>(errors.errors_px.size());
  std::vector<double> lengths_px;
  for (const Eigen::Vector2d& error_px : errors.errors_px) {
    statistics.mean_px += error_px / n;
    lengths_px.push_back(error_px.norm());
    statistics.rms_px += error_px.squaredNorm() / n;
  }
  for (const Eigen::Vector2d& error_px : errors.errors_px) {
    statistics.stdev_px += (error_px - statistics.mean_px).cwiseAbs2() / n;
  }
  statistics.stdev_px = statistics.stdev_px.cwiseSqrt();
  statistics.rms_px = std::sqrt(statistics.rms_px);
  statistics.median_px = median(std::move(lengths_px));
  statistics.max_polar_angle_rad = *std::max_element(errors.polar_angles_rad.begin(), errors.polar_angles_rad.end());
  statistics.bands = polarBands(errors);
  return statistics;
}

}  // namespace

std::vector<CameraStatistics> residualStatistics(const Solution& solution,
                                                 const std::vector<Eigen::Vector3d>& target_points) {
  const std::vector<Eigen::Vector3d> points = warpedPoints(target_points, solution.board_warp_m);
  std::vector<Errors> errors(solution.rig.cameras.size());
  for (std::size_t view = 0; view < solution.views.size(); ++view) {
    for (const observation::CameraView& image : solution.views[view].cameras) {
      const std::size_t i = static_cast<std::size_t>(image.camera_index);
      addImage(solution.rig.cameras[i], solution.T_rig_target[view], points, image, errors[i]);
    }
  }
  std::vector<CameraStatistics> statistics;
  for (const Errors& camera_errors : errors) {
    statistics.push_back(statisticsOf(camera_errors));
  }
  return statistics;
}

}  // namespace tartan_calib::calibration
