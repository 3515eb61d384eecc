#include "tartan_calib/io/camchain.h"

#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include <regex>

#include "example_result.h"
#include "support/expect_message.h"
#include "tartan_calib/error.h"

namespace tartan_calib::io {
namespace {

using test_support::expectMessage;

// Files that Kalibr wrote.
constexpr const char* kKalibrStereo = R"(cam0:
  cam_overlaps: [1]
  camera_model: pinhole
  distortion_coeffs: [0.0032890169239939526, 0.0006801256119351238, -0.0019788277828588913, 0.00016582939091634797]
  distortion_model: equidistant
  intrinsics: [280.76627569116476, 279.9683121815999, 322.3341994051097, 236.82780471452563]
  resolution: [640, 480]
  rostopic: /cam0/image_raw
cam1:
  T_cn_cnm1:
  - [0.9999999999999566, -4.944983433150552e-08, 2.8971040361918807e-07, 2.45509342867305e-08]
  - [4.9449784901921675e-08, 0.999999999999984, 1.7061722529016418e-07, -4.9539025409628815e-08]
  - [-2.8971041205617706e-07, -1.7061721096403966e-07, 0.9999999999999433, 2.6369528544410742e-08]
  - [0.0, 0.0, 0.0, 1.0]
  cam_overlaps: [0]
  camera_model: pinhole
  distortion_coeffs: [0.003287735587349329, 0.0006848089607552261, -0.0019839343488289637, 0.00016748939306604848]
  distortion_model: equidistant
  intrinsics: [280.7663250788523, 279.9683397706202, 322.3340969569546, 236.82778848225988]
  resolution: [640, 480]
  rostopic: /cam1/image_raw
)";

constexpr const char* kKalibrOmni = R"(cam0:
  cam_overlaps: []
  camera_model: omni
  distortion_coeffs: [-0.044350648238396725, 0.19034679868979643, -1.1125061315705107e-05, 3.394604768212488e-05]
  distortion_model: radtan
  intrinsics: [1.8261057894951722, 793.2642993668074, 791.0036305482136, 322.3199730717985, 236.83209981483648]
  resolution: [640, 480]
  rostopic: /cam0/image_raw
)";

constexpr const char* kKalibrDs = R"(cam0:
  cam_overlaps: []
  camera_model: ds
  distortion_coeffs: []
  distortion_model: none
  intrinsics: [-0.21105497295774261, 0.5698367596863374, 158.27320807112022, 157.96699155718457, 318.64269970074884, 242.24728429979504]
  resolution: [640, 480]
  rostopic: /cam0/image_raw
)";

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

/// Lines without those of T_cn_cnm1, whose last digits depend on how the rotation is stored.
std::string withoutBaselines(const std::string& text) { return std::regex_replace(text, std::regex("  - \\[.*\\]\n"), ""); }

TEST(Camchain, ReadingAndWritingKalibrsFileGivesItsBytes) {
  EXPECT_EQ(camchainText(parseCamchain(kKalibrOmni, "omni")), kKalibrOmni);
  EXPECT_EQ(camchainText(parseCamchain(kKalibrDs, "ds")), kKalibrDs);
  EXPECT_EQ(withoutBaselines(camchainText(parseCamchain(kKalibrStereo, "two"))), withoutBaselines(kKalibrStereo));
}

TEST(Camchain, KalibrsBaselineSurvivesToRounding) {
  const Camchain chain = parseCamchain(kKalibrStereo, "two");
  const Eigen::Matrix4d T = chain.rig.cameras[1].T_cam_rig.matrix();
  EXPECT_NEAR(T(0, 2), 2.8971040361918807e-07, 1e-15);
  EXPECT_NEAR(T(1, 0), 4.9449784901921675e-08, 1e-15);
  EXPECT_DOUBLE_EQ(T(2, 3), 2.6369528544410742e-08);
}

/// Three cameras in a row whose consecutive transforms differ.
calibration::Rig exampleRig() {
  calibration::Rig rig;
  const std::initializer_list<double> parameters = {400.5, 401.25, 320.0, 240.0, -0.28, 0.07, 0.0002, 1e-5};
  for (int i = 0; i < 3; ++i) {
    const geometry::Rigid3 T(geometry::expRotation(Eigen::Vector3d(0.1, -0.2, 0.05) * i),
                             Eigen::Vector3d(-0.1, 0.02, 0.3) * i);
    rig.cameras.push_back({exampleCamera("pinhole-radtan", parameters), T});
  }
  return rig;
}

TEST(Camchain, BaselinesChainFromCameraToCamera) {
  pipeline::CalibrationResult result = resultOf(exampleRig().cameras);
  const YAML::Node yaml = YAML::Load(camchainText(camchain(result)));
  const geometry::Rigid3 T_2_1 =
      result.solution.rig.cameras[2].T_cam_rig * result.solution.rig.cameras[1].T_cam_rig.inverse();
  for (std::size_t row = 0; row < 4; ++row) {
    for (std::size_t col = 0; col < 4; ++col) {
      EXPECT_DOUBLE_EQ(yaml["cam2"]["T_cn_cnm1"][row][col].as<double>(),
                       T_2_1.matrix()(static_cast<Eigen::Index>(row), static_cast<Eigen::Index>(col)));
    }
  }
  EXPECT_FALSE(yaml["cam0"]["T_cn_cnm1"].IsDefined());
}

TEST(Camchain, OverlapsAreCamerasWithCommonCorners) {
  pipeline::CalibrationResult result = resultOf(exampleRig().cameras);
  result.graph.shared_corners << 9, 4, 0, 4, 9, 7, 0, 7, 9;
  const Camchain chain = camchain(result);
  EXPECT_EQ(chain.overlaps, (std::vector<std::vector<int>>{{1}, {0, 2}, {1}}));
}

TEST(Camchain, EveryModelSurvivesTheRoundTrip) {
  for (const std::string& name : camera::modelNames()) {
    const camera::CameraModel start = camera::startModel(camera::modelByName(name), 300.1, {319.7, 241.3});
    Camchain chain;
    chain.rig.cameras = {{{start, 640, 480}, geometry::Rigid3()}};
    chain.topics = {"/cam0"};
    chain.overlaps = {{}};
    const Camchain read = parseCamchain(camchainText(chain), "chain.yaml");
    const camera::Camera& camera = read.rig.cameras[0].camera;
    EXPECT_EQ(camera::modelName(camera.model), name);
    EXPECT_EQ(camera::parameters(camera.model), camera::parameters(start));
    EXPECT_EQ(camera.width, 640);
    EXPECT_EQ(camera.height, 480);
    EXPECT_EQ(read.topics, chain.topics);
    EXPECT_EQ(read.overlaps, chain.overlaps);
  }
}

TEST(Camchain, CamerasAreSortedAsText) {
  Camchain chain;
  for (int i = 0; i < 11; ++i) {
    chain.rig.cameras.push_back(exampleRig().cameras[0]);
    chain.topics.emplace_back("/cam");
    chain.overlaps.emplace_back();
  }
  const std::string text = camchainText(chain);
  EXPECT_LT(text.find("\ncam1:"), text.find("\ncam10:"));
  EXPECT_LT(text.find("\ncam10:"), text.find("\ncam2:"));
}

TEST(Camchain, CornersBeyondKalibrsHemisphereAreAComment) {
  const camera::Camera equi = exampleCamera("pinhole-equi", {200, 200, 320, 240, 0.01, 0, 0, 0});
  pipeline::CalibrationResult result = resultOf({{equi, geometry::Rigid3()}});
  result.cameras[0].statistics.max_polar_angle_rad = 1.5;
  EXPECT_EQ(camchainText(camchain(result)).find('#'), std::string::npos);
  result.cameras[0].statistics.max_polar_angle_rad = 1.7;
  const std::string text = camchainText(camchain(result));
  EXPECT_EQ(text.rfind("# cam0: corners to 97.4 degrees", 0), 0U) << text;
  EXPECT_EQ(parseCamchain(text, "chain").rig.cameras.size(), 1U);
}

/// What Kalibr's reader asks of a camera: types as PyYAML sees them, lengths by model, ranges.
void expectKalibrReads(const YAML::Node& camera) {
  const std::regex is_float(R"([-+]?[0-9][0-9_]*\.[0-9_]*([eE][-+][0-9]+)?)");  // of YAML 1.1 in PyYAML
  const std::regex is_int("[-+]?(0|[1-9][0-9_]*)");
  const std::map<std::string, std::size_t> num_intrinsics = {{"pinhole", 4}, {"omni", 5}, {"eucm", 6}, {"ds", 6}};
  const std::map<std::string, std::size_t> num_distortion = {{"none", 0}, {"radtan", 4}, {"equidistant", 4}, {"fov", 1}};
  const auto model = camera["camera_model"].as<std::string>();
  const auto distortion = camera["distortion_model"].as<std::string>();
  ASSERT_EQ(num_intrinsics.count(model), 1U);
  ASSERT_EQ(num_distortion.count(distortion), 1U);
  EXPECT_EQ(camera["intrinsics"].size(), num_intrinsics.at(model));
  EXPECT_EQ(camera["distortion_coeffs"].size(), num_distortion.at(distortion));
  for (const std::string key : {"intrinsics", "distortion_coeffs"}) {
    ASSERT_TRUE(camera[key].IsSequence());
    for (const YAML::Node& value : camera[key]) {
      EXPECT_TRUE(std::regex_match(value.Scalar(), is_float)) << value.Scalar();
    }
  }
  ASSERT_EQ(camera["resolution"].size(), 2U);
  for (const YAML::Node& value : camera["resolution"]) {
    EXPECT_TRUE(std::regex_match(value.Scalar(), is_int)) << value.Scalar();
    EXPECT_GT(value.as<int>(), 0);
  }
  EXPECT_TRUE(camera["rostopic"].IsScalar());
  const std::size_t focal = num_intrinsics.at(model) - 4;
  for (std::size_t i = focal; i < focal + 4; ++i) {
    EXPECT_GE(camera["intrinsics"][i].as<double>(), 0.0);
  }
  if (model == "omni" || model == "eucm") {
    EXPECT_GE(camera["intrinsics"][0].as<double>(), 0.0);
  }
  if (model == "eucm" || model == "ds") {
    const double alpha = camera["intrinsics"][model == "ds" ? 1 : 0].as<double>();
    EXPECT_GE(alpha, 0.0);
    EXPECT_LT(alpha, 1.0);
  }
}

TEST(Camchain, PassesTheRulesOfKalibrsReader) {
  calibration::Rig rig = exampleRig();
  rig.cameras.push_back({exampleCamera("ds-none", {-0.2, 0.57, 460.0, 1e16, 3e-5, 240.0}), rig.cameras[1].T_cam_rig});
  rig.cameras.push_back({exampleCamera("eucm-none", {0.6, 1.0, 460.0, 460, 320, 240.0}), rig.cameras[2].T_cam_rig});
  rig.cameras.push_back({exampleCamera("omni-none", {0.0, 460.0, 460, 320, 240.0}), rig.cameras[2].T_cam_rig});
  rig.cameras.push_back({exampleCamera("pinhole-fov", {460.0, 460, 320, 240.0, 1.0}), rig.cameras[2].T_cam_rig});
  const YAML::Node yaml = YAML::Load(camchainText(camchain(resultOf(rig.cameras))));
  ASSERT_EQ(yaml.size(), rig.cameras.size());
  for (std::size_t i = 0; i < yaml.size(); ++i) {
    const YAML::Node camera = yaml["cam" + std::to_string(i)];
    SCOPED_TRACE("cam" + std::to_string(i));
    expectKalibrReads(camera);
    EXPECT_EQ(camera["T_cn_cnm1"].IsDefined(), i > 0);
  }
}

TEST(CamchainReader, EveryMissingKeyIsNamedWithFileAndCamera) {
  for (const std::string key : {"camera_model", "distortion_coeffs", "distortion_model", "intrinsics", "resolution"}) {
    const std::string text = std::regex_replace(std::string(kKalibrDs), std::regex("  " + key + ": .*\n"), "");
    expectMessage<InputError>([&] { parseCamchain(text, "chain.yaml"); },
                              {"chain.yaml:", "cam0", "'" + key + "'", "missing"});
  }
  const std::string no_baseline = std::regex_replace(std::string(kKalibrStereo), std::regex("  (T_cn_cnm1:|- ).*\n"), "");
  expectMessage<InputError>([&] { parseCamchain(no_baseline, "chain.yaml"); },
                            {"chain.yaml:", "cam1", "'T_cn_cnm1'", "missing"});
}

TEST(CamchainReader, ExtrinsicsMayBeMissingWhereTheCallerSaysSo) {
  const std::string no_baseline = std::regex_replace(std::string(kKalibrStereo), std::regex("  (T_cn_cnm1:|- ).*\n"), "");
  const Camchain chain = parseCamchain(no_baseline, "chain.yaml", Extrinsics::kOptional);
  EXPECT_FALSE(chain.has_extrinsics);
  EXPECT_EQ(chain.rig.cameras.size(), 2U);
  EXPECT_TRUE(parseCamchain(kKalibrStereo, "chain.yaml", Extrinsics::kOptional).has_extrinsics);
  EXPECT_TRUE(parseCamchain(kKalibrDs, "chain.yaml", Extrinsics::kOptional).has_extrinsics);
}

TEST(CamchainReader, EveryBadValueIsNamedWithFileCameraAndKey) {
  const auto expect_rejected = [](const char* base, const std::string& from, const std::string& to,
                                  std::initializer_list<std::string> parts) {
    SCOPED_TRACE(to);
    expectMessage<InputError>([&] { parseCamchain(replaced(base, from, to), "chain.yaml"); }, parts);
  };
  expect_rejected(kKalibrDs, "camera_model: ds", "camera_model: dss", {"chain.yaml:3", "cam0", "camera_model", "dss/none"});
  expect_rejected(kKalibrDs, "camera_model: ds", "camera_model: [ds]", {"chain.yaml:3", "cam0", "camera_model", "[ds]"});
  expect_rejected(kKalibrDs, ", 242.24728429979504]", "]", {"chain.yaml:6", "cam0", "intrinsics", "6 numbers"});
  expect_rejected(kKalibrDs, "158.27320807112022", "fu", {"chain.yaml:6", "cam0", "intrinsics", "6 numbers"});
  expect_rejected(kKalibrDs, "158.27320807112022", "-158.0", {"chain.yaml:6", "cam0", "intrinsics", "number 3 from 1"});
  expect_rejected(kKalibrDs, "0.5698367596863374", "1.5", {"chain.yaml:6", "cam0", "intrinsics", "number 2 from 0"});
  expect_rejected(kKalibrDs, "distortion_coeffs: []", "distortion_coeffs: [0.1]",
                  {"cam0", "distortion_coeffs", "0 numbers"});
  expect_rejected(kKalibrDs, "distortion_coeffs: []", "distortion_coeffs:", {"cam0", "distortion_coeffs", "0 numbers"});
  expect_rejected(kKalibrDs, "[640, 480]", "[640.0, 480]", {"chain.yaml:7", "cam0", "resolution", "[width, height]"});
  expect_rejected(kKalibrDs, "[640, 480]", "[640]", {"chain.yaml:7", "cam0", "resolution"});
  expect_rejected(kKalibrDs, "[640, 480]", "[640, 0]", {"chain.yaml:7", "cam0", "resolution"});
  expect_rejected(kKalibrDs, "cam_overlaps: []", "cam_overlaps: all", {"chain.yaml:2", "cam0", "cam_overlaps"});
  expect_rejected(kKalibrStereo, "  - [0.0, 0.0, 0.0, 1.0]\n", "", {"chain.yaml:", "cam1", "T_cn_cnm1", "4 rows"});
  expect_rejected(kKalibrStereo, "0.9999999999999566", "0.5", {"cam1", "T_cn_cnm1", "rotation"});
  expect_rejected(kKalibrStereo, "0.9999999999999566", "-1.0", {"cam1", "T_cn_cnm1", "rotation"});
  expect_rejected(kKalibrStereo, "[0.0, 0.0, 0.0, 1.0]", "[0.0, 0.0, 1.0, 1.0]", {"cam1", "T_cn_cnm1", "last row"});
  expect_rejected(kKalibrStereo, "cam1:", "cam2:", {"chain.yaml", "cam1 is missing"});
  expect_rejected(kKalibrDs, "cam0:", "cam0: 3\nx:", {"chain.yaml", "cam"});
}

TEST(CamchainReader, ANumberWithoutAPointIsANumber) {
  const Camchain chain = parseCamchain(replaced(kKalibrDs, "158.27320807112022", "158"), "chain");
  EXPECT_EQ(camera::parameters(chain.rig.cameras[0].camera.model)(2), 158.0);
}

TEST(CamchainReader, KeysOfLaterToolsAreAccepted) {
  const std::string text = replaced(kKalibrDs, "  resolution", "  timeshift_cam_imu: 0.001\n  resolution");
  EXPECT_EQ(parseCamchain(text, "chain").rig.cameras.size(), 1U);
}

TEST(CamchainReader, AnEmptyOrBrokenFileIsAnError) {
  for (const std::string text : {"", "{}", "cam0", "cam0: [", "cam0:\n"}) {
    expectMessage<InputError>([&] { parseCamchain(text, "chain.yaml"); }, {"chain.yaml"});
  }
}

TEST(CamchainReader, AnotherKindOfFileIsNoCamchain) {
  for (const std::string text : {"{}", "target_type: 'aprilgrid'\ntagCols: 6\n"}) {
    expectMessage<InputError>([&] { parseCamchain(text, "board.yaml"); }, {"board.yaml is no camchain"});
  }
}

}  // namespace
}  // namespace tartan_calib::io
