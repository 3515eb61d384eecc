#include "../../src/pipeline/pupil_hint.h"

#include <gtest/gtest.h>

#include "support/simulated_scene.h"
#include "tartan_calib/calibration/statistics.h"
#include "tartan_calib/text.h"

namespace tartan_calib::pipeline {
namespace {

camera::Camera fisheye(const std::string& model, const std::vector<double>& shape) {
  std::vector<double> values = shape;
  values.insert(values.begin() + (model == "ds-none" ? 2 : 0), {300.0, 301.0, 379.0, 255.0});
  const Eigen::Map<const Eigen::VectorXd> parameters(values.data(), static_cast<Eigen::Index>(values.size()));
  return {camera::withParameters(camera::modelByName(model), parameters), 752, 480};
}

TEST(PupilHint, NamesTheCameraWhoseResidualsFallMostWithTheirRmsAndModels) {
  calibration::Rig rig{{{fisheye("ds-none", {-0.2, 0.55}), geometry::Rigid3()},
                        {fisheye("pinhole-equi", {-0.02, 0.003, -0.001, 0.0}),
                         geometry::Rigid3(Eigen::Matrix3d::Identity(), Eigen::Vector3d(-0.1, 0.0, 0.0))}}};
  rig.cameras[1].camera.pupil.coefficients_m.x() = 0.05;
  test_support::Scene scene = test_support::simulateScene(rig, {});
  test_support::addNoise(scene.views, 0.1, 1);
  rig.cameras[1].camera.pupil = {};
  const calibration::Solution central = calibration::solve({scene.target_points, scene.views, rig, scene.T_rig_target}, {});
  const std::optional<std::string> hint = pupilHint(central, {}, scene.target_points);
  ASSERT_TRUE(hint);
  const double rms_px = calibration::residualStatistics(central, scene.target_points)[1].rms_px;
  const std::string start = format("cam1: residuals fall from rms %.3f to 0.1", rms_px);
  EXPECT_EQ(hint->substr(0, start.size()), start);
  EXPECT_NE(hint->find("(try omni-radtan, and look for blur at the edge)"), std::string::npos) << *hint;
}

}  // namespace
}  // namespace tartan_calib::pipeline
