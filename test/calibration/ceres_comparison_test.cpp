// The batch solve against an independent solver. Built where Ceres is installed.
#ifdef TARTAN_CALIB_WITH_CERES

#include <ceres/ceres.h>
#include <ceres/rotation.h>
#include <gtest/gtest.h>

#include <cmath>

#include "solve_scenes.h"

namespace tartan_calib::calibration {
namespace {

/// Motion as angle-axis, then translation: Ceres' own rotation, not ours.
using Motion = Eigen::Matrix<double, 6, 1>;

Motion motionOf(const geometry::Rigid3& T) {
  Motion motion;
  const Eigen::AngleAxisd rotation(T.rotation);
  motion << rotation.angle() * rotation.axis(), T.translation;
  return motion;
}

Eigen::Vector3d moved(const double* motion, const Eigen::Vector3d& p) {
  Eigen::Vector3d result;
  ceres::AngleAxisRotatePoint(motion, p.data(), result.data());
  return result + Eigen::Map<const Eigen::Vector3d>(motion + 3);
}

/// Reprojection error of one corner; derivatives are numeric, so that nothing of ours but the camera model is shared.
struct ReprojectionError {
  camera::CameraModel model;
  Eigen::Vector3d p_target;
  Eigen::Vector2d px;

  bool operator()(double const* const* blocks, double* error) const {
    const camera::CameraModel current =
        camera::withParameters(model, Eigen::Map<const Eigen::VectorXd>(blocks[0], camera::numParameters(model)));
    const auto predicted_px = camera::project(current, moved(blocks[1], moved(blocks[2], p_target)));
    if (!predicted_px) {
      return false;
    }
    Eigen::Map<Eigen::Vector2d>(error, 2) = *predicted_px - px;
    return true;
  }
};

struct CeresRig {
  std::vector<Eigen::VectorXd> parameters;
  std::vector<Motion> cameras;
  std::vector<Motion> boards;
};

CeresRig startOf(const Problem& problem) {
  CeresRig rig;
  for (const RigCamera& rig_camera : problem.rig.cameras) {
    rig.parameters.push_back(camera::parameters(rig_camera.camera.model));
    rig.cameras.push_back(motionOf(rig_camera.T_cam_rig));
  }
  for (const geometry::Rigid3& T_rig_target : problem.T_rig_target) {
    rig.boards.push_back(motionOf(T_rig_target));
  }
  return rig;
}

/// Minimises the plain sum of squares.
ceres::Solver::Summary solveWithCeres(const Problem& problem, CeresRig& rig) {
  ceres::Problem ceres_problem;
  for (std::size_t k = 0; k < problem.views.size(); ++k) {
    for (const observation::CameraView& image : problem.views[k].cameras) {
      const std::size_t i = static_cast<std::size_t>(image.camera_index);
      for (const observation::Corner& corner : image.corners) {
        auto* cost = new ceres::DynamicNumericDiffCostFunction<ReprojectionError, ceres::CENTRAL>(
            new ReprojectionError{problem.rig.cameras[i].camera.model,
                                  problem.target_points[static_cast<std::size_t>(corner.corner_id)], corner.px});
        cost->AddParameterBlock(static_cast<int>(rig.parameters[i].size()));
        cost->AddParameterBlock(6);
        cost->AddParameterBlock(6);
        cost->SetNumResiduals(2);
        ceres_problem.AddResidualBlock(cost, nullptr, rig.parameters[i].data(), rig.cameras[i].data(), rig.boards[k].data());
      }
    }
  }
  ceres_problem.SetParameterBlockConstant(rig.cameras[0].data());
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_SCHUR;
  options.function_tolerance = 1e-15;
  options.gradient_tolerance = 1e-15;
  options.parameter_tolerance = 1e-12;
  options.max_num_iterations = 100;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &ceres_problem, &summary);
  return summary;
}

TEST(CeresComparison, BothFindTheSameMinimum) {
  Random random(7);
  SceneOptions scene_options;
  scene_options.num_views = 8;
  scene_options.max_corners = 50;
  const Scene scene =
      test_support::simulateScene(rowOfCameras({"ds-none", "pinhole-equi", "omni-radtan"}, random), scene_options);
  Problem problem = noisyProblem(scene, 0.2, 5);
  disturbStart(problem, random);

  CeresRig rig = startOf(problem);
  const ceres::Solver::Summary summary = solveWithCeres(problem, rig);
  SolveOptions options;
  options.remove_outliers = false;
  const Solution solution = solve(problem, options);

  double our_cost = 0.0;
  for (std::size_t k = 0; k < solution.views.size(); ++k) {
    for (const observation::CameraView& image : solution.views[k].cameras) {
      for (const observation::Corner& corner : image.corners) {
        our_cost +=
            0.5 * residual(solution.rig, solution.T_rig_target[k],
                           problem.target_points[static_cast<std::size_t>(corner.corner_id)], image.camera_index, corner.px)
                      ->squaredNorm();
      }
    }
  }
  EXPECT_NEAR(our_cost, summary.final_cost, 1e-8 * summary.final_cost);
  for (int i = 0; i < 3; ++i) {
    // The solve ends within a thousandth of a stdev.
    const Eigen::VectorXd difference = parametersOf(solution.rig, i) - rig.parameters[static_cast<std::size_t>(i)];
    const Eigen::VectorXd sigma =
        solution.covariance.diagonal().segment(intrinsicsRow(solution.rig, i), difference.size()).cwiseSqrt();
    EXPECT_LT(difference.cwiseQuotient(sigma).cwiseAbs().maxCoeff(), 2e-3) << "cam" << i;
  }
}

}  // namespace
}  // namespace tartan_calib::calibration

#endif  // TARTAN_CALIB_WITH_CERES
