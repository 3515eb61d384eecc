#include "batch_problem.h"

#include <algorithm>
#include <limits>
#include <numeric>

namespace tartan_calib::calibration {
namespace {

constexpr int kPoseSize = 6;
constexpr int kWarpSize = 2;

bool contains(const std::vector<int>& list, int value) { return std::find(list.begin(), list.end(), value) != list.end(); }

/// Adds the local terms of one image to those of its view.
class TermsAssembler {
 public:
  TermsAssembler(const LocalTerms& local, const geometry::Matrix6d& J_xi_pose, solver::BlockTerms& terms)
      : local_(local), J_xi_pose_(J_xi_pose), terms_(terms) {}

  void addPose() {
    const geometry::Matrix6d H_pose = local_.H.topLeftCorner<kPoseSize, kPoseSize>();
    terms_.H_bb += J_xi_pose_.transpose() * H_pose * J_xi_pose_;
    terms_.g_b += J_xi_pose_.transpose() * local_.g.head<kPoseSize>();
  }

  /// The shared unknowns at [at, at + size) of the view's list are the local ones at [local_at, local_at + size).
  struct Part {
    int at = 0;
    int local_at = 0;
    int size = 0;
  };

  void addShared(const std::vector<Part>& parts) {
    for (const Part& part : parts) {
      terms_.g_s.segment(part.at, part.size) += local_.g.segment(part.local_at, part.size);
      terms_.H_bs.middleCols(part.at, part.size) +=
          J_xi_pose_.transpose() * local_.H.block(0, part.local_at, kPoseSize, part.size);
      for (const Part& other : parts) {
        terms_.H_ss.block(part.at, other.at, part.size, other.size) +=
            local_.H.block(part.local_at, other.local_at, part.size, other.size);
      }
    }
  }

 private:
  const LocalTerms& local_;
  const geometry::Matrix6d& J_xi_pose_;
  solver::BlockTerms& terms_;
};

void appendRange(int first, int size, std::vector<int>& list) {
  for (int i = 0; i < size; ++i) {
    list.push_back(first + i);
  }
}

}  // namespace

SharedLayout::SharedLayout(const Rig& rig, const SolveOptions& options)
    : extrinsics_(rig.cameras.size(), kHeld), intrinsics_(rig.cameras.size(), kHeld) {
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
      state_{problem.rig, problem.T_rig_target, problem.board_warp_m},
      previous_(state_) {
  board_.bend(state_.board_warp_m);
}

ResidualBlock BatchProblem::residualBlock(int view, const CameraMeasurements& measurements) const {
  const std::size_t camera_index = static_cast<std::size_t>(measurements.camera_index);
  const RigCamera& rig_camera = state_.rig.cameras[camera_index];
  return {measurements, board_, rig_camera.camera,
          rig_camera.T_cam_rig * state_.T_rig_target[static_cast<std::size_t>(view)], losses_[camera_index]};
}

double BatchProblem::cost(int view) const {
  double sum = 0.0;
  for (const CameraMeasurements& image : views_[static_cast<std::size_t>(view)]) {
    sum += blockCost(residualBlock(view, image));
  }
  return sum;
}

solver::BlockTerms BatchProblem::linearize(int view) const {
  const ViewMeasurements& images = views_[static_cast<std::size_t>(view)];
  solver::BlockTerms terms;
  std::vector<std::vector<TermsAssembler::Part>> parts(images.size());
  for (std::size_t i = 0; i < images.size(); ++i) {
    const int camera_index = images[i].camera_index;
    const int num_parameters =
        camera::numParameters(state_.rig.cameras[static_cast<std::size_t>(camera_index)].camera.model);
    const auto touch = [&](int offset, int local_at, int size) {
      if (offset != SharedLayout::kHeld) {
        parts[i].push_back({static_cast<int>(terms.shared.size()), local_at, size});
        appendRange(offset, size, terms.shared);
      }
    };
    touch(layout_.extrinsics(camera_index), 0, kPoseSize);
    touch(layout_.intrinsics(camera_index), kPoseSize, num_parameters);
  }
  const int warp_at = static_cast<int>(terms.shared.size());
  if (layout_.warp() != SharedLayout::kHeld) {
    appendRange(layout_.warp(), kWarpSize, terms.shared);
  }

  const Eigen::Index size = static_cast<Eigen::Index>(terms.shared.size());
  terms.H_ss = Eigen::MatrixXd::Zero(size, size);
  terms.g_s = Eigen::VectorXd::Zero(size);
  terms.H_bs = solver::BlockRows::Zero(solver::kBlockSize, size);
  for (std::size_t i = 0; i < images.size(); ++i) {
    const LocalTerms local = linearizeBlock(residualBlock(view, images[i]));
    if (layout_.warp() != SharedLayout::kHeld) {
      parts[i].push_back({warp_at, static_cast<int>(local.g.size()) - kWarpSize, kWarpSize});
    }
    // T_cam_rig exp(xi) = exp(Ad(T_cam_rig) xi) T_cam_rig.
    const RigCamera& rig_camera = state_.rig.cameras[static_cast<std::size_t>(images[i].camera_index)];
    const geometry::Matrix6d J_xi_pose = geometry::adjoint(rig_camera.T_cam_rig);
    terms.cost += local.cost;
    TermsAssembler assembler(local, J_xi_pose, terms);
    assembler.addPose();
    assembler.addShared(parts[i]);
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
    limits.lower.segment(at, parameters.size()) = (camera::lowerBound(model) - parameters).cwiseMin(0.0);
    limits.upper.segment(at, parameters.size()) = (camera::upperBound(model) - parameters).cwiseMax(0.0);
  }
  return limits;
}

void BatchProblem::move(const solver::Step& step) {
  previous_ = state_;
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
      const Eigen::VectorXd moved = old + step.shared.segment(intrinsics, old.size());
      model = camera::withParameters(model, moved.cwiseMax(camera::lowerBound(model)).cwiseMin(camera::upperBound(model)));
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

void BatchProblem::undo() {
  state_ = previous_;
  board_.bend(state_.board_warp_m);
}

}  // namespace tartan_calib::calibration
