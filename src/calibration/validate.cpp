#include "tartan_calib/calibration/validate.h"

#include <algorithm>
#include <cmath>

#include "tartan_calib/calibration/pose.h"
#include "tartan_calib/calibration/solve.h"
#include "tartan_calib/median.h"

namespace tartan_calib::calibration {
namespace {

using geometry::Rigid3;
using observation::CameraView;
using observation::View;

constexpr double kBandWidth_rad = M_PI / 18.0;

/// More than the three others of a tag that was taken for another one.
constexpr std::size_t kNumNeighbours = 8;
constexpr std::size_t kMinCorners = 5;  ///< of an image, to tell which of them is wrong
/// A wrong corner is off from its neighbours by so many times what is usual, and by no less than this.
constexpr double kWrongRatio = 7.0;
constexpr double kMinWrong_px = 1.0;

/// A view of one or several cameras at the pose from which it is solved.
std::optional<Rigid3> startPose(const Rig& rig, const std::vector<Eigen::Vector3d>& target_points, const View& view) {
  std::optional<Rigid3> T_rig_target;
  std::size_t most_corners = 0;
  for (const CameraView& image : view.cameras) {
    const RigCamera& camera = rig.cameras.at(static_cast<std::size_t>(image.camera_index));
    if (image.corners.size() <= most_corners) {
      continue;
    }
    if (const auto T_cam_target = estimatePose(camera.camera, target_points, image.corners)) {
      T_rig_target = camera.T_cam_rig.inverse() * *T_cam_target;
      most_corners = image.corners.size();
    }
  }
  return T_rig_target;
}

/// T_rig_target that suits all cameras of the view best; the lens stays, so every step of the solve is one pose's.
std::optional<Rigid3> boardPose(const Rig& rig, const std::vector<Eigen::Vector3d>& target_points, const View& view) {
  const std::optional<Rigid3> start = startPose(rig, target_points, view);
  if (!start) {
    return std::nullopt;
  }
  SolveOptions options;
  options.num_threads = 1;
  options.fix_intrinsics = true;
  options.fix_extrinsics = true;
  const Problem problem{target_points, {view}, rig, {*start}, Eigen::Vector2d::Zero()};
  return solve(problem, options).T_rig_target.front();
}

ImageErrors errorsOf(const RigCamera& camera, const Rigid3& T_rig_target, const std::vector<Eigen::Vector3d>& target_points,
                     const CameraView& image) {
  ImageErrors errors{image.camera_index, image.stamp_ns, camera.T_cam_rig * T_rig_target, {}, 0};
  for (const observation::Corner& corner : image.corners) {
    const Eigen::Vector3d p_cam = errors.T_cam_target * target_points.at(static_cast<std::size_t>(corner.corner_id));
    if (const auto px = camera::project(camera.camera, p_cam)) {
      const double polar_rad = std::atan2(p_cam.head<2>().norm(), p_cam.z());
      errors.corners.push_back({corner.corner_id, corner.px, corner.px - *px, polar_rad, false});
    } else {
      ++errors.num_unprojectable;
    }
  }
  return errors;
}

/// The corners nearest to one on the board.
std::vector<std::size_t> neighboursOf(const std::vector<CornerError>& corners, std::size_t index,
                                      const std::vector<Eigen::Vector3d>& target_points) {
  const auto point = [&](std::size_t i) { return target_points[static_cast<std::size_t>(corners[i].corner_id)]; };
  std::vector<std::pair<double, std::size_t>> others;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    if (i != index) {
      others.emplace_back((point(i) - point(index)).squaredNorm(), i);
    }
  }
  const std::size_t count = std::min(kNumNeighbours, others.size());
  std::partial_sort(others.begin(), others.begin() + static_cast<std::ptrdiff_t>(count), others.end());
  std::vector<std::size_t> neighbours;
  for (std::size_t i = 0; i < count; ++i) {
    neighbours.push_back(others[i].second);
  }
  return neighbours;
}

/// How far the error of a corner, and those of half of its neighbours, are from the median of the latter.
struct Deviation {
  double own_px = 0.0;
  double usual_px = 0.0;
};

Deviation deviationFromNeighbours(const std::vector<CornerError>& corners, std::size_t index,
                                  const std::vector<Eigen::Vector3d>& target_points) {
  const std::vector<std::size_t> neighbours = neighboursOf(corners, index, target_points);
  std::vector<double> u;
  std::vector<double> v;
  for (const std::size_t i : neighbours) {
    u.push_back(corners[i].error_px.x());
    v.push_back(corners[i].error_px.y());
  }
  const Eigen::Vector2d middle_px(upperMedian(u), upperMedian(v));
  std::vector<double> distances_px;
  for (const std::size_t i : neighbours) {
    distances_px.push_back((corners[i].error_px - middle_px).norm());
  }
  return {(corners[index].error_px - middle_px).norm(), upperMedian(distances_px)};
}

/// A lens that is wrong at its rim has errors that grow there from corner to corner: usual is what the neighbourhood says.
void markWrongCorners(const std::vector<Eigen::Vector3d>& target_points, std::vector<CornerError>& corners) {
  if (corners.size() < kMinCorners) {
    return;
  }
  std::vector<Deviation> deviations;
  std::vector<double> own_px;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    deviations.push_back(deviationFromNeighbours(corners, i, target_points));
    own_px.push_back(deviations.back().own_px);
  }
  const double usual_px = upperMedian(own_px);
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const double limit_px = std::max(kMinWrong_px, kWrongRatio * std::max(usual_px, deviations[i].usual_px));
    corners[i].is_wrong = deviations[i].own_px > limit_px;
  }
}

/// Of the images of the view at the one pose that suits all of them best; empty where there is none.
std::vector<ImageErrors> errorsAtBestPose(const Rig& rig, const std::vector<Eigen::Vector3d>& target_points,
                                          const View& view) {
  std::vector<ImageErrors> images;
  if (const std::optional<Rigid3> T_rig_target = boardPose(rig, target_points, view)) {
    for (const CameraView& image : view.cameras) {
      const RigCamera& camera = rig.cameras[static_cast<std::size_t>(image.camera_index)];
      images.push_back(errorsOf(camera, *T_rig_target, target_points, image));
      markWrongCorners(target_points, images.back().corners);
    }
  }
  return images;
}

/// The value below which a share of the values lies, between the two nearest. Sorts.
double quantile(std::vector<double>& values, double share) {
  std::sort(values.begin(), values.end());
  const double position = share * static_cast<double>(values.size() - 1);
  const auto below = static_cast<std::size_t>(position);
  const std::size_t above = std::min(below + 1, values.size() - 1);
  return values[below] + (position - static_cast<double>(below)) * (values[above] - values[below]);
}

}  // namespace

ViewErrors validateView(const Rig& rig, const std::vector<Eigen::Vector3d>& target_points, const observation::View& view) {
  ViewErrors errors;
  errors.stamp_ns = view.stamp_ns;
  errors.together = errorsAtBestPose(rig, target_points, view);
  if (view.cameras.size() == 1) {
    errors.alone = errors.together;
    return errors;
  }
  for (const CameraView& image : view.cameras) {
    const std::vector<ImageErrors> alone = errorsAtBestPose(rig, target_points, {view.stamp_ns, {image}});
    errors.alone.insert(errors.alone.end(), alone.begin(), alone.end());
  }
  return errors;
}

ErrorSummary summarizeCorners(const std::vector<CornerError>& corners) {
  ErrorSummary summary;
  std::vector<double> lengths_px;
  double sum_px2 = 0.0;
  for (const CornerError& corner : corners) {
    if (!corner.is_wrong) {
      lengths_px.push_back(corner.error_px.norm());
      summary.mean_px += corner.error_px;
      sum_px2 += corner.error_px.squaredNorm();
    }
  }
  if (lengths_px.empty()) {
    return summary;
  }
  constexpr double kMedian = 0.5;
  constexpr double k95Percent = 0.95;
  const auto n = static_cast<double>(lengths_px.size());
  summary.num_corners = static_cast<int>(lengths_px.size());
  summary.mean_px /= n;
  summary.rms_px = std::sqrt(sum_px2 / n);
  summary.median_px = quantile(lengths_px, kMedian);
  summary.percentile95_px = quantile(lengths_px, k95Percent);
  summary.max_px = lengths_px.back();
  return summary;
}

CameraErrors summarizeErrors(const std::vector<ImageErrors>& images) {
  CameraErrors summary;
  std::vector<CornerError> all;
  std::vector<std::vector<CornerError>> by_band;
  for (const ImageErrors& image : images) {
    ++summary.num_images;
    summary.num_unprojectable += image.num_unprojectable;
    for (const CornerError& corner : image.corners) {
      if (corner.is_wrong) {
        ++summary.num_wrong;
        continue;
      }
      const auto band = static_cast<std::size_t>(corner.polar_rad / kBandWidth_rad);
      by_band.resize(std::max(by_band.size(), band + 1));
      by_band[band].push_back(corner);
      all.push_back(corner);
      summary.max_polar_rad = std::max(summary.max_polar_rad, corner.polar_rad);
    }
  }
  summary.errors = summarizeCorners(all);
  for (std::size_t i = 0; i < by_band.size(); ++i) {
    const double from_rad = kBandWidth_rad * static_cast<double>(i);
    summary.bands.push_back({from_rad, from_rad + kBandWidth_rad, summarizeCorners(by_band[i])});
  }
  return summary;
}

}  // namespace tartan_calib::calibration
