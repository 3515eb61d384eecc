#include "compare_camchains/comparison.h"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <set>
#include <sstream>
#include <utility>

#include "tartan_calib/calibration/compare.h"
#include "tartan_calib/error.h"

namespace tartan_calib::apps {
namespace {

constexpr double kSampleSpacing_px = 10.0;

/// A recording has corners near a pixel where one lies in the same square of this size.
constexpr double kCell_px = 40.0;

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
    if (ray && std::atan2(ray->head<2>().norm(), ray->z()) <= region.max_angle_rad &&
        std::all_of(seen.begin(), seen.end(), has_corners)) {
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

void writeParameters(std::ostream& out, const camera::CameraModel& a, const camera::CameraModel& b) {
  constexpr int kWidth = 14;
  const Eigen::VectorXd first = camera::parameters(a);
  const Eigen::VectorXd second = camera::parameters(b);
  for (Eigen::Index i = 0; i < first.size(); ++i) {
    out << "  " << std::setw(kWidth) << first[i] << std::setw(kWidth) << second[i] << std::setw(kWidth) << std::showpos
        << first[i] - second[i] << std::noshowpos << '\n';
  }
}

}  // namespace

std::vector<CameraComparison> compareRigs(const calibration::Rig& a, const calibration::Rig& b,
                                          const ComparisonRegion& region) {
  checkSameRig(a, b);
  std::vector<CameraComparison> comparisons;
  comparisons.reserve(a.cameras.size());
  for (std::size_t i = 0; i < a.cameras.size(); ++i) {
    const calibration::RigCamera& first = a.cameras[i];
    const calibration::RigCamera& second = b.cameras[i];
    const auto projection = calibration::compareProjections(first.camera.model, second.camera.model,
                                                            samplesOf(first.camera, i, region), region.distance_m);
    const geometry::Rigid3 T_a_b = first.T_cam_rig * second.T_cam_rig.inverse();
    comparisons.push_back({projection.rms_px, projection.max_px, geometry::logRigid(T_a_b).tail<3>().norm(),
                           (first.T_cam_rig.translation - second.T_cam_rig.translation).norm()});
  }
  return comparisons;
}

std::string comparisonText(const io::Camchain& a, const io::Camchain& b, const ComparisonRegion& region) {
  constexpr double kDegreesPerRadian = 57.29577951308232;
  constexpr double kMilli = 1e3;
  const std::vector<CameraComparison> comparisons = compareRigs(a.rig, b.rig, region);
  std::ostringstream out;
  out << std::fixed << std::setprecision(6);
  for (std::size_t i = 0; i < comparisons.size(); ++i) {
    const camera::CameraModel& first = a.rig.cameras[i].camera.model;
    const camera::CameraModel& second = b.rig.cameras[i].camera.model;
    out << "cam" << i << ", " << camera::modelName(first) << " and " << camera::modelName(second) << '\n';
    if (first.index() == second.index()) {
      out << "  parameters of both in the camchain's order, and their difference:\n";
      writeParameters(out, first, second);
    }
    out << "  projection to " << std::setprecision(1) << region.max_angle_rad * kDegreesPerRadian << std::setprecision(6)
        << (region.recordings.empty() ? " degrees: differs by " : " degrees, where there are corners: differs by ")
        << comparisons[i].rms_px << " px rms, " << comparisons[i].max_px << " px at most\n";
    if (i > 0) {
      out << "  place on the rig: differs by " << comparisons[i].rotation_rad * kMilli << " mrad and "
          << comparisons[i].translation_m * kMilli << " mm\n";
    }
  }
  return out.str();
}

}  // namespace tartan_calib::apps
