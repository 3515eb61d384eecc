#include "../../src/pipeline/check_solution.h"

#include <gtest/gtest.h>

#include "support/expect_message.h"
#include "tartan_calib/error.h"

namespace tartan_calib::pipeline {
namespace {

/// Two cameras with a focal length of 100 px that is certain to 1 px, unless it is changed.
calibration::Solution unconverged() {
  const Eigen::Vector4d pinhole(100.0, 100.0, 50.0, 50.0);
  const Eigen::Matrix<double, 6, 1> sphere = (Eigen::Matrix<double, 6, 1>() << 0.1, 0.5, 100, 100, 50, 50).finished();
  calibration::Solution solution;
  solution.status = calibration::SolveStatus::kMaxIterations;
  solution.rig.cameras = {{{camera::withParameters(camera::modelByName("pinhole-none"), pinhole), 100, 100}, {}},
                          {{camera::withParameters(camera::modelByName("ds-none"), sphere), 100, 100}, {}}};
  solution.covariance = Eigen::MatrixXd::Identity(16, 16);
  return solution;
}

constexpr int kFocalOfCam0 = 6;          ///< rows of the covariance: after the baseline
constexpr int kFocalOfCam1 = 6 + 4 + 2;  ///< after xi and alpha

TEST(CheckSolution, WithoutConvergenceAMeaninglessFocalLengthIsAnError) {
  for (const auto& [row, camera] : {std::pair(kFocalOfCam0, "cam0"), std::pair(kFocalOfCam1 + 1, "cam1")}) {
    calibration::Solution solution = unconverged();
    solution.covariance(row, row) = 19.0 * 19.0;
    EXPECT_NO_THROW(checkSolution(solution));
    solution.covariance(row, row) = 21.0 * 21.0;
    test_support::expectMessage<CalibrationError>([&] { checkSolution(solution); }, {camera, "21 %", "in sync", "--models"});
  }
}

TEST(CheckSolution, AConvergedOneOrOneWithoutCovarianceIsLeftToTheWarnings) {
  calibration::Solution solution = unconverged();
  solution.covariance(kFocalOfCam0, kFocalOfCam0) = 1e6;
  solution.status = calibration::SolveStatus::kConverged;
  EXPECT_NO_THROW(checkSolution(solution));
  solution = unconverged();
  solution.covariance.resize(0, 0);
  EXPECT_NO_THROW(checkSolution(solution));
}

}  // namespace
}  // namespace tartan_calib::pipeline
