#include "../../src/pipeline/check_solution.h"

#include <gtest/gtest.h>

#include <array>
#include <functional>

#include "support/expect_message.h"
#include "tartan_calib/error.h"

namespace tartan_calib::pipeline {
namespace {

/// Two cameras with a focal length of 100 px that is certain, unless it is changed.
calibration::Solution unconverged() {
  const Eigen::Vector4d pinhole(100.0, 100.0, 50.0, 50.0);
  const Eigen::Matrix<double, 6, 1> sphere = (Eigen::Matrix<double, 6, 1>() << 0.1, 0.5, 100, 100, 50, 50).finished();
  calibration::Solution solution;
  solution.status = calibration::SolveStatus::kMaxIterations;
  solution.rig.cameras = {{{camera::withParameters(camera::modelByName("pinhole-none"), pinhole), 100, 100}, {}},
                          {{camera::withParameters(camera::modelByName("ds-none"), sphere), 100, 100}, {}}};
  solution.covariance = 1e-6 * Eigen::MatrixXd::Identity(16, 16);
  return solution;
}

constexpr int kFocalOfCam0 = 6;          ///< rows of the covariance: after the baseline
constexpr int kFocalOfCam1 = 6 + 4 + 2;  ///< after xi and alpha

TEST(CheckSolution, WithoutConvergenceAMeaninglessFocalLengthIsAnError) {
  for (const auto& [row, camera] : {std::pair(kFocalOfCam0, "cam0"), std::pair(kFocalOfCam1, "cam1")}) {
    calibration::Solution solution = unconverged();
    solution.covariance(row, row) = 19.0 * 19.0;
    EXPECT_NO_THROW(checkSolution(solution, false));
    solution.covariance(row, row) = 21.0 * 21.0;
    test_support::expectMessage<CalibrationError>([&] { checkSolution(solution, false); },
                                                  {camera, "21 %", "in sync", "--models"});
  }
}

TEST(CheckSolution, AFocalLengthThatXiMakesUpForIsKnowledge) {
  calibration::Solution solution = unconverged();
  const Eigen::Vector3d direction(1.1, 100.0, 100.0);  // 1 + xi, fu and fv grow alike: the scale on the axis stays
  const std::array<int, 3> rows = {kFocalOfCam1 - 2, kFocalOfCam1, kFocalOfCam1 + 1};
  for (std::size_t i = 0; i < rows.size(); ++i) {
    for (std::size_t j = 0; j < rows.size(); ++j) {
      solution.covariance(rows[i], rows[j]) = direction(static_cast<int>(i)) * direction(static_cast<int>(j));
    }
  }
  EXPECT_NO_THROW(checkSolution(solution, false));
}

TEST(CheckSolution, AConvergedOneOrOneWithoutCovarianceIsLeftToTheWarnings) {
  calibration::Solution solution = unconverged();
  solution.covariance(kFocalOfCam0, kFocalOfCam0) = 1e6;
  solution.status = calibration::SolveStatus::kConverged;
  EXPECT_NO_THROW(checkSolution(solution, false));
  solution = unconverged();
  solution.covariance.resize(0, 0);
  EXPECT_NO_THROW(checkSolution(solution, false));
}

/// Both cameras in every view, each with a corner, which is used where `used` says so of view and camera.
calibration::Solution converged(const std::function<bool(int, int)>& used) {
  calibration::Solution solution = unconverged();
  solution.status = calibration::SolveStatus::kConverged;
  solution.counts.resize(2);
  for (int v = 0; v < 4; ++v) {
    observation::View view;
    for (int camera = 0; camera < 2; ++camera) {
      observation::Corner corner;
      corner.used = used(v, camera);
      solution.counts[static_cast<std::size_t>(camera)].used += corner.used ? 1 : 0;
      view.cameras.push_back({camera, v, {corner}});
    }
    solution.views.push_back(view);
  }
  return solution;
}

TEST(CheckSolution, ACameraOfWhichNoCornerIsUsedIsAnError) {
  EXPECT_NO_THROW(checkSolution(converged([](int, int) { return true; }), true));
  const calibration::Solution solution = converged([](int, int camera) { return camera == 0; });
  for (const bool is_rig_open : {true, false}) {
    test_support::expectMessage<CalibrationError>([&] { checkSolution(solution, is_rig_open); },
                                                  {"cam1", "none", "in sync"});
  }
}

TEST(CheckSolution, CamerasWhoseUsedCornersShareNoViewAreAnErrorUnlessTheRigIsKnown) {
  const calibration::Solution solution = converged([](int view, int camera) { return view % 2 == camera; });
  test_support::expectMessage<CalibrationError>([&] { checkSolution(solution, true); },
                                                {"not connected", "{cam0}, {cam1}", "cam0-cam1 0", "in sync"});
  EXPECT_NO_THROW(checkSolution(solution, false));
  EXPECT_NO_THROW(checkSolution(converged([](int view, int camera) { return view == 3 || view % 2 == camera; }), true));
}

}  // namespace
}  // namespace tartan_calib::pipeline
