#include "compare_calibrations/comparison.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "tartan_calib/error.h"

namespace tartan_calib::apps {
namespace {

constexpr double kBandWidth_rad = M_PI / 18.0;

/// A recording has corners near a pixel where one lies in the same square of this size.
constexpr double kCell_px = 40.0;

double polarAngle(const Eigen::Vector3d& ray) { return std::atan2(ray.head<2>().norm(), ray.z()); }

using Cell = std::pair<int, int>;

Cell cellOf(const Eigen::Vector2d& px) {
  return {static_cast<int>(std::floor(px.x() / kCell_px)), static_cast<int>(std::floor(px.y() / kCell_px))};
}

std::set<Cell> cellsWithCorners(const std::vector<pipeline::CameraCorners>& recording, std::size_t camera_index) {
  if (camera_index >= recording.size()) {
    throw InputError("a corners file has " + std::to_string(recording.size()) + " cameras, too few for cam" +
                     std::to_string(camera_index));
  }
  std::set<Cell> cells;
  for (const observation::CameraView& image : recording[camera_index].images) {
    for (const observation::Corner& corner : image.corners) {
      if (corner.used) {
        cells.insert(cellOf(corner.px));
      }
    }
  }
  return cells;
}

/// Pixels of a grid over the image that belong to the region.
std::vector<Eigen::Vector2d> samplesOf(const camera::Camera& camera, std::size_t camera_index,
                                       const ComparisonRegion& region) {
  std::vector<std::set<Cell>> seen;
  for (const std::vector<pipeline::CameraCorners>& recording : region.recordings) {
    seen.push_back(cellsWithCorners(recording, camera_index));
  }
  std::vector<Eigen::Vector2d> samples;
  for (const Eigen::Vector2d& px : calibration::imageGrid(camera.width, camera.height, kSampleSpacing_px)) {
    const auto has_corners = [&px](const std::set<Cell>& cells) { return cells.count(cellOf(px)) > 0; };
    const auto ray = camera::unproject(camera.model, px);
    if (ray && polarAngle(*ray) <= region.max_angle_rad && std::all_of(seen.begin(), seen.end(), has_corners)) {
      samples.push_back(px);
    }
  }
  return samples;
}

void checkSameRig(const calibration::Rig& a, const calibration::Rig& b) {
  if (a.cameras.size() != b.cameras.size()) {
    throw InputError("the calibrations have " + std::to_string(a.cameras.size()) + " and " +
                     std::to_string(b.cameras.size()) + " cameras; they must be of the same rig");
  }
  for (std::size_t i = 0; i < a.cameras.size(); ++i) {
    const camera::Camera& first = a.cameras[i].camera;
    const camera::Camera& second = b.cameras[i].camera;
    if (first.width != second.width || first.height != second.height) {
      throw InputError("cam" + std::to_string(i) + " has images of different sizes in the two calibrations");
    }
  }
}

MotionSize sizeOf(const geometry::Rigid3& T) { return {geometry::logRigid(T).tail<3>().norm(), T.translation.norm()}; }

/// By how much two T_second_first differ; translations as vectors in the frame of the second camera of a.
MotionSize differenceOf(const geometry::Rigid3& a, const geometry::Rigid3& b) {
  return {sizeOf(a * b.inverse()).rotation_rad, (a.translation - b.translation).norm()};
}

std::vector<PairComparison> comparePairs(const calibration::Rig& a, const calibration::Rig& b,
                                         const std::vector<CameraComparison>& cameras) {
  std::vector<PairComparison> pairs;
  for (std::size_t i = 0; i < a.cameras.size(); ++i) {
    for (std::size_t j = i + 1; j < a.cameras.size(); ++j) {
      const geometry::Rigid3 T_ja_ia = a.cameras[j].T_cam_rig * a.cameras[i].T_cam_rig.inverse();
      const geometry::Rigid3 T_jb_ib = b.cameras[j].T_cam_rig * b.cameras[i].T_cam_rig.inverse();
      const geometry::Rigid3 without_frames = cameras[j].projection.T_b_a.inverse() * T_jb_ib * cameras[i].projection.T_b_a;
      pairs.push_back(
          {static_cast<int>(i), static_cast<int>(j), differenceOf(T_ja_ia, T_jb_ib), differenceOf(T_ja_ia, without_frames)});
    }
  }
  return pairs;
}

CameraComparison compareCameras(const camera::CameraModel& a, const camera::CameraModel& b,
                                const std::vector<Eigen::Vector2d>& samples_px, const ComparisonRegion& region) {
  CameraComparison comparison;
  comparison.projection = calibration::compareProjections(a, b, samples_px, region.distance_m);
  std::vector<DifferenceBand>& bands = comparison.bands;
  for (const calibration::PixelDifference& pixel : comparison.projection.pixels) {
    const auto index = static_cast<std::size_t>(polarAngle(*camera::unproject(a, pixel.px)) / kBandWidth_rad);
    while (bands.size() <= index) {
      const double from_rad = kBandWidth_rad * static_cast<double>(bands.size());
      bands.push_back({from_rad, from_rad + kBandWidth_rad, 0, 0.0, 0.0, 0.0});
    }
    const double length_px = pixel.difference_px.norm();
    ++bands[index].num_pixels;
    bands[index].mean_px += length_px;
    bands[index].rms_px += length_px * length_px;
    bands[index].max_px = std::max(bands[index].max_px, length_px);
    comparison.mean_px += length_px / static_cast<double>(comparison.projection.pixels.size());
  }
  for (DifferenceBand& band : bands) {
    const double n = std::max(1, band.num_pixels);
    band.mean_px /= n;
    band.rms_px = std::sqrt(band.rms_px / n);
  }
  return comparison;
}

}  // namespace

RigComparison compareRigs(const calibration::Rig& a, const calibration::Rig& b, const ComparisonRegion& region) {
  checkSameRig(a, b);
  RigComparison comparison;
  for (std::size_t i = 0; i < a.cameras.size(); ++i) {
    const camera::Camera& first = a.cameras[i].camera;
    comparison.cameras.push_back(
        compareCameras(first.model, b.cameras[i].camera.model, samplesOf(first, i, region), region));
  }
  comparison.pairs = comparePairs(a, b, comparison.cameras);
  return comparison;
}

}  // namespace tartan_calib::apps
