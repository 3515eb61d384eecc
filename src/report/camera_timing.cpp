#include "tartan_calib/report/camera_timing.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <map>

#include "board_motion.h"
#include "tartan_calib/geometry/linear_solve.h"
#include "tartan_calib/median.h"

namespace tartan_calib::report {
namespace {

constexpr double kNsPerMs = 1e6;

using Matrix2Xd = Eigen::Matrix<double, 2, Eigen::Dynamic>;

/// Normal equations of one view's pose, of all corners.
struct ViewEquations {
  explicit ViewEquations(int num_shared) : H_pose_shared(Eigen::MatrixXd::Zero(6, num_shared)) {}

  geometry::Matrix6d H = geometry::Matrix6d::Zero();
  geometry::Vector6d b = geometry::Vector6d::Zero();         ///< J' residual
  geometry::Matrix6d H_camera = geometry::Matrix6d::Zero();  ///< share of the fitted camera
  geometry::Vector6d b_camera = geometry::Vector6d::Zero();
  Eigen::MatrixXd H_pose_shared;  ///< with the cameras' unknowns
  int num_corners = 0;            ///< of the fitted camera
};

/// Derivatives of a pixel: with a motion xi of the board in the rig frame, T_rig_target <- exp(xi) T_rig_target, and with
/// what the camera has of its own, its parameters and a motion of its frame.
struct PixelChange {
  Eigen::Matrix<double, 2, 6> J_px_pose;
  Matrix2Xd J_px_shared;
};

std::optional<PixelChange> pixelChange(const calibration::RigCamera& rig_camera, const Eigen::Vector3d& p_rig) {
  const Eigen::Vector3d p_cam = rig_camera.T_cam_rig * p_rig;
  camera::Matrix23d J_px_pcam;
  camera::ParameterJacobian J_px_parameters;
  if (!camera::project(rig_camera.camera.model, p_cam, &J_px_pcam, &J_px_parameters)) {
    return std::nullopt;
  }
  const auto motion = [](const Eigen::Vector3d& p) {
    Eigen::Matrix<double, 3, 6> J_p_xi;
    J_p_xi << Eigen::Matrix3d::Identity(), -geometry::hat(p);
    return J_p_xi;
  };
  PixelChange change;
  change.J_px_pose = J_px_pcam * rig_camera.T_cam_rig.rotation.toRotationMatrix() * motion(p_rig);
  change.J_px_shared.resize(2, J_px_parameters.cols() + 6);
  change.J_px_shared << J_px_parameters, J_px_pcam * motion(p_cam);
  return change;
}

/// Fit of one camera's delay. With r the residuals of the solution, m the board's motion in a millisecond and g = J m on the
/// camera's corners, the delay minimises |r - J xi - K s - g delay|^2 over it, new poses xi of all views, and new parameters
/// and places s of all cameras. What these take up is no evidence for a delay. All corners weigh the same, unlike in the
/// solution, which trusts a camera the less the larger its residuals are: out of sync it would believe one camera alone.
class DelayFit {
 public:
  struct Scene {
    const calibration::Solution& solution;
    const std::vector<Eigen::Vector3d>& points;  ///< of the board
    const BoardMotions& motions;
    const std::vector<SeenCorners>& corners;
  };

  DelayFit(const Scene& scene, int camera_index) : scene_(scene), fitted_camera_(camera_index) {
    for (const calibration::RigCamera& rig_camera : scene_.solution.rig.cameras) {
      first_shared_.push_back(num_shared_);
      num_shared_ += camera::numParameters(rig_camera.camera.model) + 6;
    }
    H_shared_ = Eigen::MatrixXd::Zero(num_shared_, num_shared_);
    b_shared_ = Eigen::VectorXd::Zero(num_shared_);
    coupling_ = Eigen::VectorXd::Zero(num_shared_);
    for (std::size_t i = 0; i < scene.corners.size(); ++i) {
      for (const FoundCorner& corner : scene.corners[i].found) {
        addCorner(corner, static_cast<int>(i));
      }
    }
    for (const auto& [view, equations] : equations_) {
      H_shared_ -= equations.H_pose_shared.transpose() * geometry::solveSymmetric(equations.H, equations.H_pose_shared);
      b_shared_ -= equations.H_pose_shared.transpose() * geometry::solveTwist(equations.H, equations.b);
      addMotion(equations, *scene.motions[static_cast<std::size_t>(view)]);
    }
  }

  /// False where the board does not move, or where other unknowns can take its motion up.
  bool isDetermined() const { return information() > kMinInformation * squared_velocity_ && squared_velocity_ > 0.0; }
  double delay_ns() const { return kNsPerMs * (product_ - coupling_.dot(cameraUnknowns(b_shared_))) / information(); }
  double delayStdev_ns() const { return kNsPerMs * std::sqrt(squares_px2_ / std::max(1, num_components_) / information()); }
  double speedPerMs_px() const { return std::sqrt(squared_velocity_ / std::max(1, num_moving_)); }

 private:
  static constexpr double kMinInformation = 1e-6;  // of that which known poses and cameras would give

  int numOwn() const {
    return camera::numParameters(scene_.solution.rig.cameras[static_cast<std::size_t>(fitted_camera_)].camera.model) + 6;
  }
  Eigen::VectorXd cameraUnknowns(const Eigen::VectorXd& right) const {
    return H_shared_.completeOrthogonalDecomposition().solve(right);
  }
  double information() const { return information_ - coupling_.dot(cameraUnknowns(coupling_)); }

  void addMotion(const ViewEquations& equations, const geometry::Vector6d& motion_per_ms) {
    const geometry::Vector6d g_pose = equations.H_camera * motion_per_ms;
    const geometry::Vector6d absorbed = geometry::solveTwist(equations.H, g_pose);
    product_ += motion_per_ms.dot(equations.b_camera) - absorbed.dot(equations.b);
    squared_velocity_ += motion_per_ms.dot(g_pose);
    information_ += motion_per_ms.dot(g_pose) - g_pose.dot(absorbed);
    const int first = first_shared_[static_cast<std::size_t>(fitted_camera_)];
    const auto own = equations.H_pose_shared.middleCols(first, numOwn());
    coupling_.segment(first, numOwn()) += own.transpose() * motion_per_ms;
    coupling_ -= equations.H_pose_shared.transpose() * absorbed;
    num_moving_ += equations.num_corners;
  }

  void addCorner(const FoundCorner& corner, int camera_index) {
    if (!corner.used || !corner.residual_px || !scene_.motions[static_cast<std::size_t>(corner.view)]) {
      return;
    }
    const calibration::RigCamera& rig_camera = scene_.solution.rig.cameras[static_cast<std::size_t>(camera_index)];
    const Eigen::Vector3d p_rig = scene_.solution.T_rig_target[static_cast<std::size_t>(corner.view)] *
                                  scene_.points[static_cast<std::size_t>(corner.corner_id)];
    const std::optional<PixelChange> change = pixelChange(rig_camera, p_rig);
    if (!change) {
      return;
    }
    const auto& J = change->J_px_pose;
    const Matrix2Xd& K = change->J_px_shared;
    const Eigen::Vector2d& r = *corner.residual_px;
    const int first = first_shared_[static_cast<std::size_t>(camera_index)];
    H_shared_.block(first, first, K.cols(), K.cols()) += K.transpose().lazyProduct(K);
    b_shared_.segment(first, K.cols()) += K.transpose().lazyProduct(r);
    squares_px2_ += r.squaredNorm();
    num_components_ += 2;

    ViewEquations& equations = equations_.try_emplace(corner.view, num_shared_).first->second;
    equations.H += J.transpose() * J;
    equations.b += J.transpose() * r;
    equations.H_pose_shared.middleCols(first, K.cols()) += J.transpose().lazyProduct(K);
    if (camera_index == fitted_camera_) {
      equations.H_camera += J.transpose() * J;
      equations.b_camera += J.transpose() * r;
      ++equations.num_corners;
    }
  }

  const Scene scene_;
  const int fitted_camera_;
  std::vector<int> first_shared_;  ///< column of each camera
  int num_shared_ = 0;
  std::map<int, ViewEquations> equations_;
  Eigen::MatrixXd H_shared_;  ///< of the cameras' unknowns, poses eliminated
  Eigen::VectorXd b_shared_;  ///< K' r, poses eliminated
  Eigen::VectorXd coupling_;  ///< of these with the delay
  double product_ = 0.0;      ///< g' r, poses eliminated
  double information_ = 0.0;  ///< g' g, poses eliminated
  double squared_velocity_ = 0.0;
  double squares_px2_ = 0.0;
  int num_components_ = 0;
  int num_moving_ = 0;
};

}  // namespace

std::vector<CameraTiming> cameraTimings(const pipeline::CalibrationResult& result, const std::vector<SeenCorners>& corners) {
  const calibration::Solution& solution = result.solution;
  const std::vector<Eigen::Vector3d> points =
      calibration::warpedPoints(target::cornerPoints(result.target), solution.board_warp_m);
  const BoardMotions motions = boardMotions(solution, points);
  std::vector<CameraTiming> timings;
  for (std::size_t i = 1; i < corners.size(); ++i) {
    CameraTiming timing;
    timing.camera_index = static_cast<int>(i);
    const DelayFit fit({solution, points, motions, corners}, timing.camera_index);
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
    }
    if (!stamp_differences_ns.empty() && fit.isDetermined()) {
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
