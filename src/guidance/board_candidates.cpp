#include "tartan_calib/guidance/board_candidates.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "tartan_calib/calibration/information.h"

namespace tartan_calib::guidance {
namespace {

using geometry::Rigid3;

constexpr int kPlacesPerSide = 5;
constexpr std::array<double, 3> kSizes = {0.35, 0.6, 0.9};  ///< of the board, as shares of the image's shorter side
constexpr double kTilt_rad = 0.6;
constexpr double kMinDistance_ratio = 0.7;     ///< of half the board's diagonal: nearer, no lens is in focus
constexpr double kMinFacing = 0.35;            ///< cosine between a corner's ray and the board's normal
constexpr double kMinSpacing_px = 6.0;         ///< of corners that a detector can resolve
constexpr double kMinBorderDistance_px = 4.0;  ///< as the detector's
constexpr double kMinSeen_ratio = 0.35;        ///< of the board's corners

struct Board {
  const std::vector<Eigen::Vector3d>& points;
  Eigen::Vector3d centre;
  double radius_m;
};

/// A pixel as a place for the board: its ray, the image's directions to the right and down there, and its scale.
struct Place {
  Eigen::Vector3d ray;
  Eigen::Vector3d right;
  Eigen::Vector3d down;
  double px_per_rad;
};

std::optional<Place> placeAt(const camera::CameraModel& model, const Eigen::Vector2d& px) {
  const auto ray = camera::unproject(model, px);
  const auto beside = camera::unproject(model, px + Eigen::Vector2d::UnitX());
  if (!ray || !beside) {
    return std::nullopt;
  }
  const Eigen::Vector3d step = *beside - ray->dot(*beside) * *ray;
  const Eigen::Vector3d right = step.normalized();
  return Place{*ray, right, ray->cross(right), 1.0 / step.norm()};
}

/// Where in the camera frame a board at that place faces when tilted.
Eigen::Vector3d tiltDirection(Tilt tilt, const Place& place) {
  switch (tilt) {
    case Tilt::kLeft:
      return -place.right;
    case Tilt::kRight:
      return place.right;
    case Tilt::kUp:
      return -place.down;
    case Tilt::kDown:
      return place.down;
    case Tilt::kNone:
      break;
  }
  return Eigen::Vector3d::Zero();
}

/// T_cam_target of a board that stands upright in the image.
Rigid3 boardPose(const Board& board, const Place& place, double distance_m, Tilt tilt) {
  Eigen::Matrix3d R_cam_facing;
  R_cam_facing << place.right, -place.down, -place.ray;
  const Eigen::Vector3d normal = -place.ray + std::tan(kTilt_rad) * tiltDirection(tilt, place);
  const Eigen::Quaterniond R = geometry::rotationBetween(-place.ray, normal) * Eigen::Quaterniond(R_cam_facing);
  return Rigid3(R, distance_m * place.ray - R * board.centre);
}

/// What the camera would see, as far as a detector finds it.
observation::CameraView visibleCorners(const calibration::RigCamera& rig_camera, const Board& board,
                                       const Rigid3& T_rig_target, const CoverageMap& coverage) {
  observation::CameraView view;
  const camera::Camera& camera = rig_camera.camera;
  const Rigid3 T_cam_target = rig_camera.T_cam_rig * T_rig_target;
  const Eigen::Vector3d normal = T_cam_target.rotation * Eigen::Vector3d::UnitZ();
  std::optional<Eigen::Vector2d> last_px;
  for (std::size_t id = 0; id < board.points.size(); ++id) {
    const Eigen::Vector3d p_cam = T_cam_target * board.points[id];
    const bool faces = -normal.dot(p_cam) >= kMinFacing * p_cam.norm();
    const auto px = faces ? camera::project(camera, p_cam) : std::nullopt;
    const bool is_resolved = px && (!last_px || (*px - *last_px).norm() >= kMinSpacing_px);
    last_px = px;
    const Eigen::Vector2d border = Eigen::Vector2d::Constant(kMinBorderDistance_px);
    if (is_resolved && camera::isInside(camera, *px - border) && camera::isInside(camera, *px + border) &&
        coverage.isLit(*px)) {
      view.corners.push_back({static_cast<int>(id), *px});
    }
  }
  return view;
}

class CandidateMaker {
 public:
  CandidateMaker(const calibration::Rig& rig, const std::vector<Eigen::Vector3d>& target_points,
                 const std::vector<CoverageMap>& coverage)
      : rig_(rig), coverage_(coverage), board_{target_points, {}, 0.0} {
    board_.centre = 0.5 * (target_points.front() + target_points.back());
    board_.radius_m = (target_points.back() - board_.centre).norm();
  }

  /// Appends the candidates around one pixel of a camera.
  void addAt(int camera_index, const Eigen::Vector2d& px, std::vector<BoardCandidate>& candidates) const {
    const auto at = static_cast<std::size_t>(camera_index);
    const camera::Camera& camera = rig_.cameras[at].camera;
    const auto place = coverage_[at].isLit(px) ? placeAt(camera.model, px) : std::nullopt;
    if (!place) {
      return;
    }
    for (const double size : kSizes) {
      const double size_rad = size * std::min(camera.width, camera.height) / place->px_per_rad;
      const double distance_m = board_.radius_m * std::max(kMinDistance_ratio, std::sqrt(2.0) / size_rad);
      for (int tilt = 0; tilt < kNumTilts; ++tilt) {
        const Rigid3 T_cam_target = boardPose(board_, *place, distance_m, static_cast<Tilt>(tilt));
        if (auto candidate = candidateAt(camera_index, T_cam_target)) {
          candidates.push_back(std::move(*candidate));
        }
      }
    }
  }

 private:
  std::optional<BoardCandidate> candidateAt(int camera_index, const Rigid3& T_cam_target) const {
    BoardCandidate candidate;
    candidate.camera_index = camera_index;
    candidate.T_rig_target = rig_.cameras[static_cast<std::size_t>(camera_index)].T_cam_rig.inverse() * T_cam_target;
    const double min_corners = kMinSeen_ratio * static_cast<double>(board_.points.size());
    for (std::size_t i = 0; i < rig_.cameras.size(); ++i) {
      observation::CameraView image = visibleCorners(rig_.cameras[i], board_, candidate.T_rig_target, coverage_[i]);
      image.camera_index = static_cast<int>(i);
      const bool is_enough = static_cast<double>(image.corners.size()) >= min_corners;
      if (!is_enough && image.camera_index == camera_index) {
        return std::nullopt;
      }
      if (is_enough) {
        candidate.view.cameras.push_back(std::move(image));
      }
    }
    candidate.information = calibration::viewInformation(rig_, board_.points, candidate.view, candidate.T_rig_target);
    return candidate;
  }

  const calibration::Rig& rig_;
  const std::vector<CoverageMap>& coverage_;
  Board board_;
};

}  // namespace

std::vector<BoardCandidate> boardCandidates(const calibration::Rig& rig, const std::vector<Eigen::Vector3d>& target_points,
                                            const std::vector<CoverageMap>& coverage) {
  const CandidateMaker maker(rig, target_points, coverage);
  std::vector<BoardCandidate> candidates;
  for (std::size_t i = 0; i < rig.cameras.size(); ++i) {
    const camera::Camera& camera = rig.cameras[i].camera;
    for (int row = 0; row < kPlacesPerSide; ++row) {
      for (int col = 0; col < kPlacesPerSide; ++col) {
        const Eigen::Vector2d px((col + 0.5) * camera.width / kPlacesPerSide - 0.5,
                                 (row + 0.5) * camera.height / kPlacesPerSide - 0.5);
        maker.addAt(static_cast<int>(i), px, candidates);
      }
    }
  }
  return candidates;
}

std::optional<BoardPlacement> boardPlacement(const calibration::RigCamera& rig_camera,
                                             const std::vector<Eigen::Vector3d>& target_points, const Rigid3& T_rig_target) {
  const camera::Camera& camera = rig_camera.camera;
  const Rigid3 T_cam_target = rig_camera.T_cam_rig * T_rig_target;
  const Eigen::Vector3d centre_cam = T_cam_target * (0.5 * (target_points.front() + target_points.back()));
  const auto centre_px = camera::project(camera, centre_cam);
  const auto place = centre_px ? placeAt(camera.model, *centre_px) : std::nullopt;
  if (!place) {
    return std::nullopt;
  }
  const Eigen::Vector3d normal = T_cam_target.rotation * Eigen::Vector3d::UnitZ();
  const double angle_rad = std::acos(std::clamp(-normal.dot(place->ray), -1.0, 1.0));
  return BoardPlacement{*centre_px, centre_cam.norm(),
                        tiltOf(Eigen::Vector2d(normal.dot(place->right), normal.dot(place->down)), angle_rad)};
}

std::vector<std::vector<Eigen::Vector2d>> boardOutline(const calibration::RigCamera& rig_camera,
                                                       const std::vector<Eigen::Vector3d>& target_points,
                                                       const Rigid3& T_rig_target) {
  constexpr int kPointsPerSide = 16;
  const Eigen::Vector3d& low = target_points.front();
  const Eigen::Vector3d& high = target_points.back();
  const std::array<Eigen::Vector3d, 4> vertices = {low, {high.x(), low.y(), 0.0}, high, {low.x(), high.y(), 0.0}};
  const Rigid3 T_cam_target = rig_camera.T_cam_rig * T_rig_target;
  std::vector<std::vector<Eigen::Vector2d>> pieces(1);
  for (int i = 0; i <= 4 * kPointsPerSide; ++i) {
    const auto side = static_cast<std::size_t>(i / kPointsPerSide % 4);
    const double share = static_cast<double>(i % kPointsPerSide) / kPointsPerSide;
    const Eigen::Vector3d p_target = (1.0 - share) * vertices.at(side) + share * vertices.at((side + 1) % 4);
    if (const auto px = camera::project(rig_camera.camera, T_cam_target * p_target)) {
      pieces.back().push_back(*px);
    } else if (!pieces.back().empty()) {
      pieces.emplace_back();
    }
  }
  return pieces;
}

}  // namespace tartan_calib::guidance
