#include "tartan_calib/report/camera_timing.h"

#include <Eigen/Cholesky>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "tartan_calib/median.h"

namespace tartan_calib::report {
namespace {

constexpr double kNsPerMs = 1e6;
constexpr std::int64_t kMaxGap_ns = 400'000'000;  ///< between neighbouring views; over longer ones a motion is no line

/// Motion of the board per millisecond in the rig frame around each view, from its neighbours' poses; empty where a
/// neighbour is missing or too far in time.
std::vector<std::optional<geometry::Vector6d>> boardMotions(const calibration::Solution& solution) {
  std::vector<std::optional<geometry::Vector6d>> motions(solution.views.size());
  const std::set<int> unsolved(solution.unsolved_views.begin(), solution.unsolved_views.end());
  for (std::size_t i = 1; i + 1 < motions.size(); ++i) {
    const std::int64_t before_ns = solution.views[i].stamp_ns - solution.views[i - 1].stamp_ns;
    const std::int64_t after_ns = solution.views[i + 1].stamp_ns - solution.views[i].stamp_ns;
    const int view = static_cast<int>(i);
    const bool is_solved = unsolved.count(view - 1) + unsolved.count(view) + unsolved.count(view + 1) == 0;
    if (is_solved && before_ns > 0 && after_ns > 0 && std::max(before_ns, after_ns) < kMaxGap_ns) {
      const geometry::Rigid3 change = solution.T_rig_target[i + 1] * solution.T_rig_target[i - 1].inverse();
      motions[i] = geometry::logRigid(change) * (kNsPerMs / static_cast<double>(before_ns + after_ns));
    }
  }
  return motions;
}

using Matrix6Xd = Eigen::Matrix<double, 6, Eigen::Dynamic>;
using Matrix2Xd = Eigen::Matrix<double, 2, Eigen::Dynamic>;

/// Normal equations of one view: pose of the board against all its corners, and the fitted camera's share of them.
struct ViewEquations {
  geometry::Matrix6d H = geometry::Matrix6d::Zero();         ///< of all cameras
  geometry::Matrix6d H_camera = geometry::Matrix6d::Zero();  ///< of the fitted camera
  geometry::Vector6d b_camera = geometry::Vector6d::Zero();  ///< J' residual of the fitted camera
  Matrix6Xd H_pose_shared;                                   ///< with the fitted camera's own unknowns
  Eigen::MatrixXd H_shared;
  int num_corners = 0;  ///< of the fitted camera
};

/// Derivatives of a pixel: with a motion xi of the board in the rig frame, T_rig_target <- exp(xi) T_rig_target, and with
/// what the camera has of its own, its parameters and a motion of its frame.
struct PixelChange {
  Eigen::Matrix<double, 2, 6> J_px_pose;
  Matrix2Xd J_px_shared;
};

template <class Model>
std::optional<PixelChange> pixelChange(const Model& model, const geometry::Rigid3& T_cam_rig, const Eigen::Vector3d& p_rig) {
  const Eigen::Vector3d p_cam = T_cam_rig * p_rig;
  Eigen::Vector2d px;
  camera::Matrix23d J_px_pcam;
  typename Model::ParameterJacobian J_px_parameters;
  if (!model.project(p_cam, px, &J_px_pcam, &J_px_parameters)) {
    return std::nullopt;
  }
  const auto motion = [](const Eigen::Vector3d& p) {
    Eigen::Matrix<double, 3, 6> J_p_xi;
    J_p_xi << Eigen::Matrix3d::Identity(), -geometry::hat(p);
    return J_p_xi;
  };
  PixelChange change;
  change.J_px_pose = J_px_pcam * T_cam_rig.rotation.toRotationMatrix() * motion(p_rig);
  change.J_px_shared.resize(2, Model::kNumParameters + 6);
  change.J_px_shared << J_px_parameters, J_px_pcam * motion(p_cam);
  return change;
}

/// Fit of one camera's delay. With r the residuals of the solution, whose derivatives with all unknowns vanish, m the
/// board's motion in a millisecond and g = J m on the camera's corners, the delay minimises |r - J xi - K s - g delay|^2
/// over it, new poses xi of all views, and new parameters and place s of the camera. What these take up is no evidence for a
/// delay.
class DelayFit {
 public:
  DelayFit(const pipeline::CalibrationResult& result, const std::vector<SeenCorners>& corners, int camera_index)
      : solution_(result.solution),
        points_(calibration::warpedPoints(target::cornerPoints(result.target), solution_.board_warp_m)),
        num_shared_(camera::numParameters(solution_.rig.cameras[static_cast<std::size_t>(camera_index)].camera.model) + 6) {
    for (std::size_t i = 0; i < corners.size(); ++i) {
      for (const FoundCorner& corner : corners[i].found) {
        addCorner(solution_.rig.cameras[i], corner, static_cast<int>(i) == camera_index);
      }
    }
    H_shared_ = Eigen::MatrixXd::Zero(num_shared_, num_shared_);
    coupling_ = Eigen::VectorXd::Zero(num_shared_);
    for (const auto& [view, equations] : equations_) {
      if (equations.num_corners > 0) {
        H_shared_ +=
            equations.H_shared - equations.H_pose_shared.transpose() * equations.H.ldlt().solve(equations.H_pose_shared);
      }
    }
  }

  void addView(int view, const geometry::Vector6d& motion_per_ms) {
    const auto found = equations_.find(view);
    if (found == equations_.end() || found->second.num_corners == 0) {
      return;
    }
    const ViewEquations& equations = found->second;
    const geometry::Vector6d g_pose = equations.H_camera * motion_per_ms;
    const geometry::Vector6d absorbed = equations.H.ldlt().solve(g_pose);
    product_ += motion_per_ms.dot(equations.b_camera);
    squared_velocity_ += motion_per_ms.dot(g_pose);
    information_ += motion_per_ms.dot(g_pose) - g_pose.dot(absorbed);
    coupling_ += equations.H_pose_shared.transpose() * (motion_per_ms - absorbed);
    num_moving_ += equations.num_corners;
  }

  /// False where the board does not move, or where other unknowns can take its motion up.
  bool isDetermined() const { return information() > kMinInformation * squared_velocity_ && squared_velocity_ > 0.0; }
  double delay_ns() const { return kNsPerMs * product_ / information(); }
  double delayStdev_ns() const { return kNsPerMs * std::sqrt(squares_px2_ / std::max(1, num_components_) / information()); }
  double speedPerMs_px() const { return std::sqrt(squared_velocity_ / std::max(1, num_moving_)); }

 private:
  static constexpr double kMinInformation = 1e-6;  // of that which known poses and cameras would give

  double information() const {
    return information_ - coupling_.dot(H_shared_.completeOrthogonalDecomposition().solve(coupling_));
  }

  void addCorner(const calibration::RigCamera& rig_camera, const FoundCorner& corner, bool is_fitted) {
    if (!corner.used || !corner.residual_px) {
      return;
    }
    const Eigen::Vector3d p_rig =
        solution_.T_rig_target[static_cast<std::size_t>(corner.view)] * points_[static_cast<std::size_t>(corner.corner_id)];
    const auto derive = [&](const auto& model) { return pixelChange(model, rig_camera.T_cam_rig, p_rig); };
    const std::optional<PixelChange> change = std::visit(derive, rig_camera.camera.model);
    if (!change) {
      return;
    }
    ViewEquations& equations = equations_[corner.view];
    const auto& J = change->J_px_pose;
    equations.H += J.transpose() * J;
    squares_px2_ += corner.residual_px->squaredNorm();
    num_components_ += 2;
    if (!is_fitted) {
      return;
    }
    if (equations.num_corners++ == 0) {
      equations.H_pose_shared = Matrix6Xd::Zero(6, num_shared_);
      equations.H_shared = Eigen::MatrixXd::Zero(num_shared_, num_shared_);
    }
    equations.H_camera += J.transpose() * J;
    equations.b_camera += J.transpose() * *corner.residual_px;
    equations.H_pose_shared += J.transpose() * change->J_px_shared;
    equations.H_shared += change->J_px_shared.transpose() * change->J_px_shared;
  }

  const calibration::Solution& solution_;
  const std::vector<Eigen::Vector3d> points_;
  const int num_shared_;
  std::map<int, ViewEquations> equations_;
  Eigen::MatrixXd H_shared_;  ///< of the camera's own unknowns, poses eliminated
  Eigen::VectorXd coupling_;  ///< of these with the delay
  double product_ = 0.0;      ///< g' r
  double information_ = 0.0;  ///< g' g, poses eliminated
  double squared_velocity_ = 0.0;
  double squares_px2_ = 0.0;
  int num_components_ = 0;
  int num_moving_ = 0;
};

}  // namespace

std::vector<CameraTiming> cameraTimings(const pipeline::CalibrationResult& result, const std::vector<SeenCorners>& corners) {
  const calibration::Solution& solution = result.solution;
  const auto motions = boardMotions(solution);
  std::vector<CameraTiming> timings;
  for (std::size_t i = 1; i < corners.size(); ++i) {
    CameraTiming timing;
    timing.camera_index = static_cast<int>(i);
    DelayFit fit(result, corners, timing.camera_index);
    std::vector<double> stamp_differences_ns;
    for (std::size_t view = 0; view < solution.views.size(); ++view) {
      const std::vector<observation::CameraView>& images = solution.views[view].cameras;
      const auto image = std::find_if(images.begin(), images.end(),
                                      [&](const auto& other) { return other.camera_index == timing.camera_index; });
      if (image == images.end() || images.size() < 2 || !motions[view]) {
        continue;
      }
      const observation::CameraView& other = image == images.begin() ? images[1] : images[0];
      stamp_differences_ns.push_back(std::abs(static_cast<double>(image->stamp_ns - other.stamp_ns)));
      fit.addView(static_cast<int>(view), *motions[view]);
    }
    if (fit.isDetermined()) {
      timing.num_views = static_cast<int>(stamp_differences_ns.size());
      timing.median_stamp_ns = upperMedian(stamp_differences_ns);
      timing.delay_ns = fit.delay_ns();
      timing.delay_stdev_ns = fit.delayStdev_ns();
      timing.speed_px_per_ms = fit.speedPerMs_px();
      timings.push_back(timing);
    }
  }
  return timings;
}

}  // namespace tartan_calib::report
