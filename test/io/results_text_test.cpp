#include "tartan_calib/io/results_text.h"

#include <gtest/gtest.h>

#include "example_result.h"

namespace tartan_calib::io {
namespace {

/// The text up to our own last lines.
std::string kalibrPart(const std::string& text) { return text.substr(0, text.find("\n# ")); }

constexpr const char* kTargetPart = R"(


Target configuration
====================

  Type: aprilgrid
  Tags: 
    Rows: 6
    Cols: 6
    Size: 0.088 [m]
    Spacing 0.026399999999999996 [m]
)";

/// Sets the statistics and the standard deviations (parameters in Kalibr's order) of one camera.
void setCamera(pipeline::CalibrationResult& result, int index, const Eigen::Vector4d& error, const Eigen::VectorXd& stdev) {
  calibration::CameraStatistics& statistics = result.cameras[static_cast<std::size_t>(index)].statistics;
  statistics.mean_px = error.head<2>();
  statistics.stdev_px = error.tail<2>();
  int row = 6 * (static_cast<int>(result.cameras.size()) - 1);
  for (int i = 0; i < index; ++i) {
    row += camera::numParameters(result.solution.rig.cameras[static_cast<std::size_t>(i)].camera.model);
  }
  result.solution.covariance.diagonal().segment(row, stdev.size()) = stdev.cwiseAbs2();
}

TEST(ResultsText, IsWhatKalibrWroteForADoubleSphere) {
  const camera::Camera camera = exampleCamera("ds-none", {-0.21105497295774261, 0.5698367596863374, 158.27320807112022,
                                                          157.96699155718457, 318.64269970074884, 242.24728429979504});
  pipeline::CalibrationResult result = resultOf({{camera, geometry::Rigid3()}});
  setCamera(result, 0, {-0.000004, 0.000006, 0.050738, 0.050980},
            vector({0.0075736, 0.00175597, 1.42700427, 1.43576844, 0.29634297, 0.28592245}));
  EXPECT_EQ(kalibrPart(resultsText(result)), R"(Calibration results 
====================
Camera-system parameters:
cam0 (/cam0/image_raw):
    type: <class 'aslam_cv.libaslam_cv_python.DoubleSphereCameraGeometry'>
    distortion: [] +- []
    projection: [ -0.21105497   0.56983676 158.27320807 157.96699156 318.6426997
 242.2472843 ] +- [0.0075736  0.00175597 1.42700427 1.43576844 0.29634297 0.28592245]
    reprojection error: [-0.000004, 0.000006] +- [0.050738, 0.050980]
)" + std::string(kTargetPart));
}

TEST(ResultsText, IsWhatKalibrWroteForAnOmniCamera) {
  const camera::Camera camera = exampleCamera(
      "omni-radtan", {1.8261057894951722, 793.2642993668074, 791.0036305482136, 322.3199730717985, 236.83209981483648,
                      -0.044350648238396725, 0.19034679868979643, -1.1125061315705107e-05, 3.394604768212488e-05});
  pipeline::CalibrationResult result = resultOf({{camera, geometry::Rigid3()}});
  setCamera(
      result, 0, {-1e-8, -1e-8, 0.048565, 0.048135},
      vector({0.00314515, 0.1510996, 0.15150021, 0.49569029, 0.43901609, 0.01021072, 0.04331043, 0.00046959, 0.00047405}));
  EXPECT_NE(resultsText(result).find(
                R"(    type: <class 'aslam_cv.libaslam_cv_python.DistortedOmniCameraGeometry'>
    distortion: [-0.04435065  0.1903468  -0.00001113  0.00003395] +- [0.01021072 0.04331043 0.00046959 0.00047405]
    projection: [  1.82610579 793.26429937 791.00363055 322.31997307 236.83209981] +- [0.00314515 0.1510996  0.15150021 0.49569029 0.43901609]
    reprojection error: [-0.000000, -0.000000] +- [0.048565, 0.048135]
)"),
            std::string::npos)
      << resultsText(result);
}

TEST(ResultsText, IsWhatKalibrWroteForAStereoPair) {
  const camera::Camera cam0 = exampleCamera(
      "pinhole-equi", {280.76627569116476, 279.9683121815999, 322.3341994051097, 236.82780471452563, 0.0032890169239939526,
                       0.0006801256119351238, -0.0019788277828588913, 0.00016582939091634797});
  const camera::Camera cam1 = exampleCamera(
      "pinhole-equi", {280.7663250788523, 279.9683397706202, 322.3340969569546, 236.82778848225988, 0.003287735587349329,
                       0.0006848089607552261, -0.0019839343488289637, 0.00016748939306604848});
  Eigen::Matrix4d T;
  T << 0.9999999999999566, -4.944983433150552e-08, 2.8971040361918807e-07, 2.45509342867305e-08,     //
      4.9449784901921675e-08, 0.999999999999984, 1.7061722529016418e-07, -4.9539025409628815e-08,    //
      -2.8971041205617706e-07, -1.7061721096403966e-07, 0.9999999999999433, 2.6369528544410742e-08,  //
      0.0, 0.0, 0.0, 1.0;
  pipeline::CalibrationResult result = resultOf({{cam0, geometry::Rigid3()}, {cam1, geometry::rigidFromMatrix(T)}});
  setCamera(result, 0, {-0.000008, 0.000001, 0.048756, 0.048431},
            vector({0.16701806, 0.16726825, 0.13667726, 0.24742129, 0.00440525, 0.00980078, 0.00843401, 0.00245365}));
  setCamera(result, 1, {0.000008, -0.000001, 0.048756, 0.048431},
            vector({0.16701771, 0.1672713, 0.13668774, 0.24742182, 0.00440522, 0.00980081, 0.00843405, 0.00245366}));
  result.solution.covariance.diagonal().head(6) =
      vector({0.00063233, 0.00088191, 0.00011612, 0.00016788, 0.00017711, 0.00032975}).cwiseAbs2();
  EXPECT_EQ(kalibrPart(resultsText(result)), R"(Calibration results 
====================
Camera-system parameters:
cam0 (/cam0/image_raw):
    type: <class 'aslam_cv.libaslam_cv_python.EquidistantDistortedPinholeCameraGeometry'>
    distortion: [ 0.00328902  0.00068013 -0.00197883  0.00016583] +- [0.00440525 0.00980078 0.00843401 0.00245365]
    projection: [280.76627569 279.96831218 322.33419941 236.82780471] +- [0.16701806 0.16726825 0.13667726 0.24742129]
    reprojection error: [-0.000008, 0.000001] +- [0.048756, 0.048431]

cam1 (/cam1/image_raw):
    type: <class 'aslam_cv.libaslam_cv_python.EquidistantDistortedPinholeCameraGeometry'>
    distortion: [ 0.00328774  0.00068481 -0.00198393  0.00016749] +- [0.00440522 0.00980081 0.00843405 0.00245366]
    projection: [280.76632508 279.96833977 322.33409696 236.82778848] +- [0.16701771 0.1672713  0.13668774 0.24742182]
    reprojection error: [0.000008, -0.000001] +- [0.048756, 0.048431]

baseline T_1_0:
    q: [ 0.00000009 -0.00000014 -0.00000002  1.        ] +- [0.00063233 0.00088191 0.00011612]
    t: [ 0.00000002 -0.00000005  0.00000003] +- [0.00016788 0.00017711 0.00032975]
)" + std::string(kTargetPart));
}

TEST(ResultsText, TheQuaternionIsJplsWithPositiveW) {
  // A right-handed turn by 90 degrees about x is Hamilton's (0.707, 0, 0, 0.707) and JPL's (-0.707, 0, 0, 0.707).
  const camera::Camera camera = exampleCamera("pinhole-none", {400, 400, 320, 240});
  const Eigen::Quaterniond R(-std::sqrt(0.5), -std::sqrt(0.5), 0.0, 0.0);
  const pipeline::CalibrationResult result =
      resultOf({{camera, geometry::Rigid3()}, {camera, geometry::Rigid3(R, Eigen::Vector3d::Zero())}});
  const std::string text = resultsText(result);
  EXPECT_NE(text.find("q: [-0.70710678  0.          0.          0.70710678] +-"), std::string::npos) << text;
}

TEST(ResultsText, SaysHowTheUncertaintyIsScaledAfterKalibrsPart) {
  const camera::Camera camera = exampleCamera("pinhole-none", {400, 400, 320, 240});
  const std::string text = resultsText(resultOf({{camera, geometry::Rigid3()}}));
  EXPECT_NE(text.find("[m]\n\n# '+-' is one standard deviation, scaled by the residuals' (0.050000 px)"), std::string::npos);
}

TEST(ResultsText, TellsTheBoardsWarpWhereItWasFitted) {
  const camera::Camera camera = exampleCamera("pinhole-none", {400, 400, 320, 240});
  pipeline::CalibrationResult result = resultOf({{camera, geometry::Rigid3()}});
  EXPECT_EQ(resultsText(result).find("Warp"), std::string::npos);
  result.solution.board_warp_m << 0.00125, -0.0025;
  result.solution.covariance = Eigen::MatrixXd::Zero(6, 6);
  result.solution.covariance.diagonal().tail<2>() << 1e-8, 4e-8;
  EXPECT_NE(
      resultsText(result).find("    Spacing 0.026399999999999996 [m]\n  Warp [m]: [ 0.00125 -0.0025 ] +- [0.0001 0.0002]\n"),
      std::string::npos)
      << resultsText(result);
}

TEST(ResultsText, PrintsCheckerboardsAsKalibr) {
  const camera::Camera camera = exampleCamera("pinhole-none", {400, 400, 320, 240});
  pipeline::CalibrationResult result = resultOf({{camera, geometry::Rigid3()}});
  result.target = target::Checkerboard{7, 10, 0.06, 0.05};
  EXPECT_NE(resultsText(result).find("====\n\n  Type: checkerboard\n  Rows\n    Count: 7\n    Distance: 0.06 [m]\n  Cols\n"
                                     "    Count: 10\n    Distance: 0.05 [m]\n"),
            std::string::npos);
  result.target = target::CircleGrid{7, 10, 0.06, false};
  EXPECT_NE(resultsText(result).find("====\n\n  Type: circlegrid\n"), std::string::npos);
}

// Expected texts below were printed by numpy 1.24 with set_printoptions(suppress=True, precision=8).
TEST(ArrayText, IsNumpys) {
  EXPECT_EQ(arrayText(Eigen::VectorXd()), "[]");
  EXPECT_EQ(arrayText(vector({0.0})), "[0.]");
  EXPECT_EQ(arrayText(vector({1.0, -2.5})), "[ 1.  -2.5]");
  EXPECT_EQ(arrayText(vector({-1e-12, 0.125})), "[-0.     0.125]");
  EXPECT_EQ(arrayText(vector({99999.123456789, 1e-9})), "[99999.12345679     0.        ]");
  EXPECT_EQ(arrayText(vector({std::nan(""), 1.5})), "[nan 1.5]");
  EXPECT_EQ(arrayText(vector({std::nan(""), std::nan("")})), "[nan nan]");
  EXPECT_EQ(arrayText(vector({1234567.1, 0.1})), "[1234567.1       0.1]");
}

TEST(ArrayText, WrapsAtNumpysWidth) {
  EXPECT_EQ(arrayText(Eigen::VectorXd::Constant(8, -0.123456789)),
            "[-0.12345679 -0.12345679 -0.12345679 -0.12345679 -0.12345679 -0.12345679\n -0.12345679 -0.12345679]");
}

TEST(ArrayText, ABracketMustFitIntoTheLineToo) {
  // A line of these five would have 75 characters up to the bracket; numpy keeps to 74.
  EXPECT_EQ(arrayText(Eigen::VectorXd::Constant(5, -1234.12345678)),
            "[-1234.12345678 -1234.12345678 -1234.12345678 -1234.12345678\n -1234.12345678]");
}

TEST(MatrixText, IsNumpys) {
  Eigen::Matrix4d T = Eigen::Matrix4d::Identity();
  T(0, 2) = -4e-8;
  T(2, 0) = 4e-8;
  T(0, 1) = -1e-12;
  EXPECT_EQ(matrixText(T),
            "[[ 1.         -0.         -0.00000004  0.        ]\n"
            " [ 0.          1.          0.          0.        ]\n"
            " [ 0.00000004  0.          1.          0.        ]\n"
            " [ 0.          0.          0.          1.        ]]");
}

}  // namespace
}  // namespace tartan_calib::io
