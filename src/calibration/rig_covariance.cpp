#include "rig_covariance.h"

#include "tartan_calib/text.h"

namespace tartan_calib::calibration {
namespace {

constexpr int kPoseSize = 6;
constexpr int kPupilSize = camera::PupilShift::kNumParameters;
constexpr int kWarpSize = 2;

const camera::CameraModel& modelOf(const Rig& rig, int camera_index) {
  return rig.cameras[static_cast<std::size_t>(camera_index)].camera.model;
}

geometry::Rigid3 baseline(const Rig& rig, int camera_index) {
  const std::size_t i = static_cast<std::size_t>(camera_index);
  return rig.cameras[i].T_cam_rig * rig.cameras[i - 1].T_cam_rig.inverse();
}

/// d[phi; t] / d(xi) of T <- exp(xi) T, with R <- exp(phi) R and t <- t + dt: dt = rho + phi x t.
geometry::Matrix6d rotationTranslationFromTangent(const Eigen::Vector3d& t) {
  geometry::Matrix6d J = geometry::Matrix6d::Zero();
  J.topRightCorner<3, 3>().setIdentity();
  J.bottomLeftCorner<3, 3>().setIdentity();
  J.bottomRightCorner<3, 3>() = -geometry::hat(t);
  return J;
}

}  // namespace

int baselineRow(int camera_index) { return kPoseSize * (camera_index - 1); }

int intrinsicsRow(const Rig& rig, int camera_index) {
  int row = kPoseSize * (static_cast<int>(rig.cameras.size()) - 1);
  for (int i = 0; i < camera_index; ++i) {
    row += camera::numParameters(modelOf(rig, i));
  }
  return row;
}

Eigen::MatrixXd baselineCovariance(const Rig& rig, const SharedLayout& layout, const Eigen::MatrixXd& shared_covariance) {
  const int num_cameras = static_cast<int>(rig.cameras.size());
  const int warp_row = intrinsicsRow(rig, num_cameras);
  const int pupil_row = warp_row + (layout.warp() != SharedLayout::kHeld ? kWarpSize : 0);
  const int num_rows = pupil_row + (layout.estimatesPupils() ? num_cameras * kPupilSize : 0);
  Eigen::MatrixXd J = Eigen::MatrixXd::Zero(num_rows, layout.size());
  for (int i = 1; i < num_cameras; ++i) {
    // exp(xi_i) T_i (exp(xi_j) T_j)^-1 = exp(xi_i - Ad(T_i_j) xi_j) T_i_j to first order, j = i - 1.
    const geometry::Rigid3 T_i_j = baseline(rig, i);
    const geometry::Matrix6d J_baseline = rotationTranslationFromTangent(T_i_j.translation);
    if (layout.extrinsics(i) != SharedLayout::kHeld) {
      J.block<kPoseSize, kPoseSize>(baselineRow(i), layout.extrinsics(i)) = J_baseline;
    }
    if (layout.extrinsics(i - 1) != SharedLayout::kHeld) {
      J.block<kPoseSize, kPoseSize>(baselineRow(i), layout.extrinsics(i - 1)) = -J_baseline * geometry::adjoint(T_i_j);
    }
  }
  for (int i = 0; i < num_cameras; ++i) {
    const int size = camera::numParameters(modelOf(rig, i));
    if (layout.intrinsics(i) != SharedLayout::kHeld) {
      J.block(intrinsicsRow(rig, i), layout.intrinsics(i), size, size).setIdentity();
    }
    if (layout.pupil(i) != SharedLayout::kHeld) {
      J.block<kPupilSize, kPupilSize>(pupil_row + i * kPupilSize, layout.pupil(i)).setIdentity();
    }
  }
  if (layout.warp() != SharedLayout::kHeld) {
    J.block<kWarpSize, kWarpSize>(warp_row, layout.warp()).setIdentity();
  }
  return J * shared_covariance * J.transpose();
}

std::string unknownName(const Rig& rig, const SharedLayout& layout, int shared_index) {
  for (int i = 0; i < static_cast<int>(rig.cameras.size()); ++i) {
    const std::string name = cameraName(i);
    const int from_extrinsics = shared_index - layout.extrinsics(i);
    if (layout.extrinsics(i) != SharedLayout::kHeld && from_extrinsics >= 0 && from_extrinsics < kPoseSize) {
      return name + " extrinsics";
    }
    const int from_pupil = shared_index - layout.pupil(i);
    if (layout.pupil(i) != SharedLayout::kHeld && from_pupil >= 0 && from_pupil < kPupilSize) {
      return name + " pupil shift";
    }
    const camera::CameraModel& model = modelOf(rig, i);
    const int from_intrinsics = shared_index - layout.intrinsics(i);
    if (layout.intrinsics(i) == SharedLayout::kHeld || from_intrinsics < 0 ||
        from_intrinsics >= camera::numParameters(model)) {
      continue;
    }
    const int from_distortion = from_intrinsics - camera::numIntrinsics(model);
    return from_distortion < 0 ? name + " projection[" + std::to_string(from_intrinsics) + "]"
                               : name + " distortion[" + std::to_string(from_distortion) + "]";
  }
  return "board warp";
}

}  // namespace tartan_calib::calibration
