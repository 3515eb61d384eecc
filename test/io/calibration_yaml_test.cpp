#include "tartan_calib/io/calibration_yaml.h"

#include <gtest/gtest.h>

#include <yaml-cpp/yaml.h>
#include <cmath>

#include "example_result.h"

namespace tartan_calib::io {
namespace {

pipeline::CalibrationResult exampleResult() {
  const camera::Camera camera = exampleCamera("pinhole-radtan", {400, 401, 320, 240, -0.28, 0.07, 0.0002, 1e-5});
  const geometry::Rigid3 T_1_0(geometry::expRotation({0.1, 0.2, 0.3}), Eigen::Vector3d(-0.11, 0.0, 0.0));
  pipeline::CalibrationResult result = resultOf({{camera, geometry::Rigid3()}, {camera, T_1_0}});
  observation::View view;
  view.stamp_ns = 1404733405732800001;
  view.cameras = {{0, 1404733405732800001, {}}, {1, 1404733405732800002, {}}};
  result.solution.views = {view};
  result.solution.T_rig_target = {T_1_0};
  result.solution.counts[1].outliers = 13;
  result.solution.undetermined = {"cam0: k2"};
  result.cameras[0].num_images = 40;
  result.cameras[0].counts.duplicate_tags = 5;
  result.cameras[0].statistics.rms_px = 0.123456789;
  result.cameras[0].statistics.bands = {{0.0, 0.17453292519943295, 1000, 0.1},
                                        {0.17453292519943295, 0.3490658503988659, 2, 0.2}};
  result.warnings = {"cam0: 'quoted': # and so on"};
  return result;
}

YAML::Node parsed(const pipeline::CalibrationResult& result, pipeline::CalibrateOptions options = {}) {
  options.models = {"pinhole-radtan", "pinhole-radtan"};
  options.solve.outlier_sigma = 3.5;
  options.projections.rectified = pipeline::ViewSize{1.0, 1.0, 800, 600};
  options.projections.pinholes = {pipeline::pinholeView({1.0, 1.0, 300, 200}, 0.5, 0.0)};
  const RunInfo run{"my bag.bag", "target.yaml", "calibrate_cameras --bag 'my bag.bag'\n"};
  return YAML::Load(calibrationText(result, options, run));
}

TEST(CalibrationYaml, HoldsTheRunAndItsOptions) {
  const YAML::Node yaml = parsed(exampleResult());
  EXPECT_TRUE(yaml["tartan_calib_version"].IsDefined());
  EXPECT_EQ(yaml["run"]["recording"].as<std::string>(), "my bag.bag");
  EXPECT_EQ(yaml["run"]["command"].as<std::string>(), "calibrate_cameras --bag 'my bag.bag'\n");
  EXPECT_EQ(yaml["options"]["models"][1].as<std::string>(), "pinhole-radtan");
  EXPECT_EQ(yaml["options"]["min_tags"].as<int>(), 7);
  EXPECT_DOUBLE_EQ(yaml["options"]["approx_sync_s"].as<double>(), 0.02);
  EXPECT_EQ(yaml["options"]["solve"]["outlier_sigma"].as<double>(), 3.5);
  EXPECT_EQ(yaml["target"]["tagSize"].as<double>(), 0.088);
}

TEST(CalibrationYaml, HoldsTheThresholdOfTheFilterThatHasOne) {
  pipeline::CalibrateOptions options;
  EXPECT_FALSE(parsed(exampleResult(), options)["options"]["max_quad_distance_px"].IsDefined());
  options.recovery.filter = detection::CornerFilter::kQuads;
  options.recovery.max_quad_distance_px = 3.18;
  EXPECT_DOUBLE_EQ(parsed(exampleResult(), options)["options"]["max_quad_distance_px"].as<double>(), 3.18);
}

TEST(CalibrationYaml, HoldsTheVirtualViews) {
  const YAML::Node options = parsed(exampleResult())["options"];
  EXPECT_EQ(options["rectified_view"].as<std::vector<int>>(), (std::vector<int>{800, 600}));
  const auto view = options["pinhole_views"][0].as<std::vector<double>>();
  ASSERT_EQ(view.size(), 15U);
  EXPECT_EQ(view[0], 300.0);
  EXPECT_EQ(view[5], 99.5);
  EXPECT_DOUBLE_EQ(view[11], -std::sin(0.5));  // row 1, column 2 of a turn about x
}

TEST(CalibrationYaml, HoldsEveryCamerasParametersCountsAndBands) {
  const YAML::Node cam0 = parsed(exampleResult())["cameras"]["cam0"];
  EXPECT_EQ(cam0["model"].as<std::string>(), "pinhole-radtan");
  EXPECT_EQ(cam0["intrinsics"][1].as<double>(), 401.0);
  EXPECT_EQ(cam0["distortion_coeffs"][3].as<double>(), 1e-5);
  EXPECT_EQ(cam0["images"]["total"].as<int>(), 40);
  EXPECT_EQ(cam0["tags"]["duplicate"].as<int>(), 5);
  EXPECT_EQ(cam0["residuals"]["rms_px"].as<double>(), 0.123456789);
  ASSERT_EQ(cam0["residuals"]["bands"].size(), 2U);
  EXPECT_EQ(cam0["residuals"]["bands"][1]["to_deg"].as<double>(), 20.0);
  EXPECT_EQ(cam0["residuals"]["bands"][0]["corners"].as<int>(), 1000);
  EXPECT_EQ(parsed(exampleResult())["cameras"]["cam1"]["corners"]["outliers"].as<int>(), 13);
}

TEST(CalibrationYaml, HoldsPosesInFullPrecision) {
  const pipeline::CalibrationResult result = exampleResult();
  const YAML::Node view = parsed(result)["views"][0];
  EXPECT_EQ(view["stamp_ns"].as<std::int64_t>(), 1404733405732800001);
  EXPECT_EQ(view["cameras"].as<std::vector<int>>(), (std::vector<int>{0, 1}));
  EXPECT_EQ(view["T_rig_target"][0].as<double>(), result.solution.T_rig_target[0].rotation.w());
  EXPECT_EQ(view["T_rig_target"][4].as<double>(), result.solution.T_rig_target[0].translation.x());
}

TEST(CalibrationYaml, NamesEveryRowOfTheCovariance) {
  const pipeline::CalibrationResult result = exampleResult();
  const YAML::Node covariance = parsed(result)["covariance"];
  ASSERT_EQ(covariance["matrix"].size(), static_cast<std::size_t>(result.solution.covariance.rows()));
  ASSERT_EQ(covariance["parameters"].size(), covariance["matrix"].size());
  EXPECT_EQ(covariance["parameters"][3].as<std::string>(), "T_1_0.x_m");
  const auto row = static_cast<std::size_t>(calibration::intrinsicsRow(result.solution.rig, 1));
  EXPECT_EQ(covariance["parameters"][row + 4].as<std::string>(), "cam1.distortion_coeffs.0");
  EXPECT_EQ(covariance["matrix"][5][5].as<double>(), 1.0);
}

TEST(CalibrationYaml, NamesTheRowsOfTheBoardsWarpAndThePupils) {
  pipeline::CalibrationResult result = exampleResult();
  const Eigen::Index rows = result.solution.covariance.rows() + 2 + 2 * 2;
  result.solution.covariance = Eigen::MatrixXd::Identity(rows, rows);
  pipeline::CalibrateOptions options;
  options.solve.estimate_board_warp = true;
  options.solve.estimate_pupil_shift = true;
  const YAML::Node names = parsed(result, options)["covariance"]["parameters"];
  ASSERT_EQ(names.size(), static_cast<std::size_t>(rows));
  EXPECT_EQ(names[names.size() - 5].as<std::string>(), "board_warp_m.1");
  EXPECT_EQ(names[names.size() - 1].as<std::string>(), "cam1.pupil_shift_m.1");
}

TEST(CalibrationYaml, WorksWithoutCovarianceAndKeepsWarnings) {
  pipeline::CalibrationResult result = exampleResult();
  result.solution.covariance.resize(0, 0);
  const YAML::Node yaml = parsed(result);
  EXPECT_EQ(yaml["covariance"]["parameters"].size(), 0U);
  EXPECT_EQ(yaml["warnings"][0].as<std::string>(), "cam0: 'quoted': # and so on");
  EXPECT_EQ(yaml["solution"]["undetermined"][0].as<std::string>(), "cam0: k2");
}

}  // namespace
}  // namespace tartan_calib::io
