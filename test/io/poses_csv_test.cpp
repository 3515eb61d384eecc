#include "tartan_calib/io/poses_csv.h"

#include <gtest/gtest.h>

#include <cmath>

#include "example_result.h"

namespace tartan_calib::io {
namespace {

TEST(PosesText, IsTheCamerasPoseInTheTargetFrameWithHamiltonsQuaternion) {
  const camera::Camera camera = exampleCamera("pinhole-none", {400, 400, 320, 240});
  pipeline::CalibrationResult result = resultOf({{camera, geometry::Rigid3()}, {camera, geometry::Rigid3()}});
  observation::View both;
  both.stamp_ns = 1404733405732800001;
  both.cameras = {{0, 1404733405732800002, {}}, {1, 1404733405732800003, {}}};
  observation::View other;
  other.stamp_ns = 1404733405832800004;
  other.cameras = {{1, 1404733405832800004, {}}};
  result.solution.views = {both, other};
  // Half a turn about the axis (1, 2, 2) / 3, and a quarter turn about (2, 1, 2) / 3.
  const Eigen::Quaterniond R_first(0.0, 1.0 / 3.0, 2.0 / 3.0, 2.0 / 3.0);
  const Eigen::Quaterniond R_second(std::sqrt(0.5), std::sqrt(2.0) / 3.0, std::sqrt(0.5) / 3.0, std::sqrt(2.0) / 3.0);
  const geometry::Rigid3 T_target_first(R_first, Eigen::Vector3d(0.25, -0.5, 1.0));
  const geometry::Rigid3 T_target_second(R_second, Eigen::Vector3d(0.1, 0.2, 1234.5678912));
  result.solution.T_rig_target = {T_target_first.inverse(), T_target_second.inverse()};
  EXPECT_EQ(posesText(result),
            "#timestamp, p_RS_R_x [m], p_RS_R_y [m], p_RS_R_z [m], q_RS_w [], q_RS_x [], q_RS_y [], q_RS_z []\n"
            "1404733405732800002,0.250000,-0.500000,1.000000,0.000000,0.333333,0.666667,0.666667\n"
            "1404733405832800004,0.100000,0.200000,1234.567891,0.707107,0.471405,0.235702,0.471405\n");
}

}  // namespace
}  // namespace tartan_calib::io
