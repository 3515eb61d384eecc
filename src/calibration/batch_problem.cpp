#include "batch_problem.h"

#include <algorithm>
#include <limits>
#include <numeric>

namespace tartan_calib::calibration {
namespace {

constexpr int kPoseSize = 6;
constexpr int kPupilSize = camera::PupilShift::kNumParameters;
constexpr int kWarpSize = 2;
constexpr double kMaxPupilShift_m = 0.05;  ///< of each coefficient: no lens of a robot is larger

bool contains(const std::vector<int>& list, int value) { return std::find(list.begin(), list.end(), value) != list.end(); }

/// The shared unknowns at [at, at + size) of a view's list are the local ones of an image at [local_at, local_at + size).
struct Part {
  int at = 0;
  int local_at = 0;
  int size = 0;
};

/// Adds the local terms of one image to those of its view. J_xi_pose = d(xi of T_cam_target) / d(xi of T_rig_target).
void addImage(const LocalTerms& local, const std::vector<Part>& parts, const geometry::Matrix6d& J_xi_pose,
              solver::BlockTerms& terms) {
  terms.cost += local.cost;
  terms.H_bb += J_xi_pose.transpose() * local.H.topLeftCorner<kPoseSize, kPoseSize>() * J_xi_pose;
  terms.g_b += J_xi_pose.transpose() * local.g.head<kPoseSize>();
  for (const Part& part : parts) {
    terms.g_s.segment(part.at, part.size) += local.g.segment(part.local_at, part.size);
    terms.H_bs.middleCols(part.at, part.size) +=
        J_xi_pose.transpose() * local.H.block(0, part.local_at, kPoseSize, part.size);
    for (const Part& other : parts) {
      terms.H_ss.block(part.at, other.at, part.size, other.size) +=
          local.H.block(part.local_at, other.local_at, part.size, other.size);
    }
  }
}

void appendRange(int first, int size, std::vector<int>& list) {
  for (int i = 0; i < size && first != SharedLayout::kHeld; ++i) {
    list.push_back(first + i);
  }
}

camera::CameraModel withinBounds(const camera::CameraModel& model, const Eigen::VectorXd& parameters) {
  return camera::withParameters(model, parameters.cwiseMax(camera::lowerBound(model)).cwiseMin(camera::upperBound(model)));
}

}  // namespace

SharedLayout::SharedLayout(const Rig& rig, const SolveOptions& options)
    : extrinsics_(rig.cameras.size(), kHeld),
      intrinsics_(rig.cameras.size(), kHeld),
      pupils_(rig.cameras.size(), kHeld),
      estimates_pupils_(options.estimate_pupil_shift) {
  const int num_cameras = static_cast<int>(rig.cameras.size());
  for (int i = 1; i < num_cameras; ++i) {
    if (!options.fix_extrinsics && !contains(options.fixed_cameras, i)) {
      extrinsics_[static_cast<std::size_t>(i)] = size_;
      size_ += kPoseSize;
    }
  }
  for (int i = 0; i < num_cameras; ++i) {
    if (!options.fix_intrinsics && !contains(options.fixed_cameras, i)) {
      intrinsics_[static_cast<std::size_t>(i)] = size_;
      size_ += camera::numParameters(rig.cameras[static_cast<std::size_t>(i)].camera.model);
      if (options.estimate_pupil_shift) {
        pupils_[static_cast<std::size_t>(i)] = size_;
        size_ += kPupilSize;
      }
    }
  }
  if (options.estimate_board_warp) {
    warp_ = size_;
    size_ += kWarpSize;
  }
}

BatchProblem::BatchProblem(const Problem& problem, const SolveOptions& options)
    : views_(measurementsOf(problem)),
      layout_(problem.rig, options),
      board_(problem.target_points),
      losses_(problem.rig.cameras.size()),
      state_{problem.rig, problem.T_rig_target, problem.board_warp_m} {
  board_.bend(state_.board_warp_m);
  for (std::size_t i = 0; i < state_.rig.cameras.size(); ++i) {
    camera::CameraModel& model = state_.rig.cameras[i].camera.model;
    if (layout_.intrinsics(static_cast<int>(i)) != SharedLayout::kHeld) {
      model = withinBounds(model, camera::parameters(model));
    }
  }
}

int BatchProblem::numParameters(int camera_index) const {
  return camera::numParameters(state_.rig.cameras[static_cast<std::size_t>(camera_index)].camera.model);
}

ResidualBlock BatchProblem::residualBlock(std::size_t view, const CameraMeasurements& measurements) const {
  const std::size_t camera_index = static_cast<std::size_t>(measurements.camera_index);
  const RigCamera& rig_camera = state_.rig.cameras[camera_index];
  return {measurements, board_, rig_camera.camera, rig_camera.T_cam_rig * state_.T_rig_target[view], losses_[camera_index]};
}

double BatchProblem::cost(int view) const {
  const std::size_t k = static_cast<std::size_t>(view);
  double sum = 0.0;
  for (const CameraMeasurements& image : views_[k]) {
    sum += blockCost(residualBlock(k, image));
  }
  return sum;
}

std::vector<int> BatchProblem::sharedOf(const ViewMeasurements& images) const {
  std::vector<int> shared;
  for (const CameraMeasurements& image : images) {
    appendRange(layout_.extrinsics(image.camera_index), kPoseSize, shared);
    appendRange(layout_.intrinsics(image.camera_index), numParameters(image.camera_index), shared);
    appendRange(layout_.pupil(image.camera_index), kPupilSize, shared);
  }
  appendRange(layout_.warp(), kWarpSize, shared);
  return shared;
}

solver::BlockTerms BatchProblem::linearize(int view) const {
  const std::size_t k = static_cast<std::size_t>(view);
  solver::BlockTerms terms;
  terms.shared = sharedOf(views_[k]);
  const int size = static_cast<int>(terms.shared.size());
  terms.H_ss = Eigen::MatrixXd::Zero(size, size);
  terms.g_s = Eigen::VectorXd::Zero(size);
  terms.H_bs = solver::BlockRows::Zero(solver::kBlockSize, size);

  int at = 0;  // in the order of sharedOf
  for (const CameraMeasurements& image : views_[k]) {
    std::vector<Part> parts;
    const auto add_part = [&](int offset, int local_at, int part_size) {
      if (offset != SharedLayout::kHeld) {
        parts.push_back({at, local_at, part_size});
        at += part_size;
      }
    };
    const int num_parameters = numParameters(image.camera_index);
    add_part(layout_.extrinsics(image.camera_index), 0, kPoseSize);
    add_part(layout_.intrinsics(image.camera_index), kPoseSize, num_parameters);
    const LocalUnknowns unknowns{layout_.pupil(image.camera_index) != SharedLayout::kHeld,
                                 layout_.warp() != SharedLayout::kHeld};
    add_part(layout_.pupil(image.camera_index), kPoseSize + num_parameters, kPupilSize);
    if (unknowns.warp) {
      const int local_at = kPoseSize + num_parameters + (unknowns.pupil ? kPupilSize : 0);
      parts.push_back({size - kWarpSize, local_at, kWarpSize});
    }
    // T_cam_rig exp(xi) = exp(Ad(T_cam_rig) xi) T_cam_rig.
    const RigCamera& rig_camera = state_.rig.cameras[static_cast<std::size_t>(image.camera_index)];
    addImage(linearizeBlock(residualBlock(k, image), unknowns), parts, geometry::adjoint(rig_camera.T_cam_rig), terms);
  }
  return terms;
}

solver::StepLimits BatchProblem::stepLimits() const {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  solver::StepLimits limits{Eigen::VectorXd::Constant(numShared(), -kInfinity),
                            Eigen::VectorXd::Constant(numShared(), kInfinity)};
  for (std::size_t i = 0; i < state_.rig.cameras.size(); ++i) {
    const int at = layout_.intrinsics(static_cast<int>(i));
    if (at == SharedLayout::kHeld) {
      continue;
    }
    const camera::CameraModel& model = state_.rig.cameras[i].camera.model;
    const Eigen::VectorXd parameters = camera::parameters(model);
    const int pupil = layout_.pupil(static_cast<int>(i));
    if (pupil != SharedLayout::kHeld) {
      const Eigen::Vector2d& now_m = state_.rig.cameras[i].camera.pupil.coefficients_m;
      limits.lower.segment<kPupilSize>(pupil) = (-now_m.array() - kMaxPupilShift_m).min(0.0);
      limits.upper.segment<kPupilSize>(pupil) = (-now_m.array() + kMaxPupilShift_m).max(0.0);
    }
    limits.lower.segment(at, parameters.size()) = (camera::lowerBound(model) - parameters).cwiseMin(0.0);
    limits.upper.segment(at, parameters.size()) = (camera::upperBound(model) - parameters).cwiseMax(0.0);
  }
  return limits;
}

void BatchProblem::move(const solver::Step& step) {
  for (std::size_t i = 0; i < state_.rig.cameras.size(); ++i) {
    RigCamera& rig_camera = state_.rig.cameras[i];
    const int extrinsics = layout_.extrinsics(static_cast<int>(i));
    if (extrinsics != SharedLayout::kHeld) {
      rig_camera.T_cam_rig = geometry::expRigid(step.shared.segment<kPoseSize>(extrinsics)) * rig_camera.T_cam_rig;
    }
    const int intrinsics = layout_.intrinsics(static_cast<int>(i));
    if (intrinsics != SharedLayout::kHeld) {
      camera::CameraModel& model = rig_camera.camera.model;
      const Eigen::VectorXd old = camera::parameters(model);
      model = withinBounds(model, old + step.shared.segment(intrinsics, old.size()));
    }
    const int pupil = layout_.pupil(static_cast<int>(i));
    if (pupil != SharedLayout::kHeld) {
      rig_camera.camera.pupil.coefficients_m += step.shared.segment<kPupilSize>(pupil);
    }
  }
  for (std::size_t k = 0; k < state_.T_rig_target.size(); ++k) {
    state_.T_rig_target[k] = geometry::expRigid(step.blocks[k]) * state_.T_rig_target[k];
  }
  if (layout_.warp() != SharedLayout::kHeld) {
    state_.board_warp_m += step.shared.segment<kWarpSize>(layout_.warp());
    board_.bend(state_.board_warp_m);
  }
}

void BatchProblem::restore() {
  state_ = saved_;
  board_.bend(state_.board_warp_m);
}

}  // namespace tartan_calib::calibration
