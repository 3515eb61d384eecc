#include "tartan_calib/calibration/information.h"

#include "batch_problem.h"
#include "tartan_calib/geometry/linear_solve.h"

namespace tartan_calib::calibration {
namespace {

/// Below this reciprocal condition the six unknowns of a pose cannot be told apart in double precision.
constexpr double kMinPoseCondition = 1e-13;

}  // namespace

Eigen::MatrixXd viewInformation(const Rig& rig, const std::vector<Eigen::Vector3d>& target_points,
                                const observation::View& view, const geometry::Rigid3& T_rig_target) {
  Problem problem;
  problem.target_points = target_points;
  problem.views = {view};
  problem.rig = rig;
  problem.T_rig_target = {T_rig_target};
  const BatchProblem batch(problem, SolveOptions{});
  const solver::BlockTerms terms = batch.linearize(0);

  Eigen::MatrixXd information = Eigen::MatrixXd::Zero(batch.numShared(), batch.numShared());
  const std::optional<Eigen::MatrixXd> pose = geometry::solveDefinite(terms.H_bb, terms.H_bs, kMinPoseCondition);
  if (!pose) {
    return information;
  }
  const Eigen::MatrixXd reduced = terms.H_ss - terms.H_bs.transpose() * *pose;
  for (std::size_t i = 0; i < terms.shared.size(); ++i) {
    for (std::size_t j = 0; j < terms.shared.size(); ++j) {
      information(terms.shared[i], terms.shared[j]) = reduced(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
    }
  }
  return information;
}

}  // namespace tartan_calib::calibration
