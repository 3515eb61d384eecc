#include "tartan_calib/calibration/statistics.h"

#include <gtest/gtest.h>

#include <cmath>

#include "solve_scenes.h"

namespace tartan_calib::calibration {
namespace {

/// A camera with f = 100 px that looks at points one metre away: x = tan(polar angle).
Solution oneView(const std::vector<observation::Corner>& corners) {
  Solution solution;
  solution.rig.cameras.push_back(
      {{camera::startModel(camera::modelByName("pinhole-none"), 100.0, {0.0, 0.0}), 640, 480}, geometry::Rigid3()});
  solution.views.push_back({0, {{0, 0, corners}}});
  solution.T_rig_target.emplace_back(Eigen::Quaterniond::Identity(), Eigen::Vector3d(0.0, 0.0, 1.0));
  return solution;
}

observation::Corner corner(int id, double u_px, double v_px) { return {id, {u_px, v_px}}; }

TEST(ResidualStatistics, AreThoseOfTheUsedCorners) {
  const double x = std::tan(25.0 * M_PI / 180.0);
  const std::vector<Eigen::Vector3d> points = {{0.0, 0.0, 0.0}, {0.01, 0.0, 0.0}, {x, 0.0, 0.0}, {x, 1.0, 0.0}};
  std::vector<observation::Corner> corners = {corner(0, 3.0, 4.0), corner(1, 0.0, 0.0), corner(2, 100.0 * x, 1.0),
                                              corner(3, 500.0, 500.0)};
  corners[3].used = false;
  const CameraStatistics statistics = residualStatistics(oneView(corners), points).at(0);
  // Errors (3, 4), (-1, 0), (0, 1).
  EXPECT_EQ(statistics.num_views, 1);
  EXPECT_EQ(statistics.num_corners, 3);
  EXPECT_NEAR(statistics.mean_px.x(), 2.0 / 3.0, 1e-12);
  EXPECT_NEAR(statistics.mean_px.y(), 5.0 / 3.0, 1e-12);
  EXPECT_NEAR(statistics.stdev_px.x(), std::sqrt(10.0 / 3.0 - 4.0 / 9.0), 1e-12);
  EXPECT_NEAR(statistics.stdev_px.y(), std::sqrt(17.0 / 3.0 - 25.0 / 9.0), 1e-12);
  EXPECT_NEAR(statistics.rms_px, 3.0, 1e-12);
  EXPECT_NEAR(statistics.median_px, 1.0, 1e-12);
  EXPECT_NEAR(statistics.max_polar_angle_rad, 25.0 * M_PI / 180.0, 1e-12);
}

TEST(ResidualStatistics, AreSplitByPolarAngle) {
  const double x = std::tan(25.0 * M_PI / 180.0);
  const std::vector<Eigen::Vector3d> points = {{0.0, 0.0, 0.0}, {0.01, 0.0, 0.0}, {x, 0.0, 0.0}};
  const std::vector<observation::Corner> corners = {corner(0, 3.0, 4.0), corner(1, 0.0, 0.0), corner(2, 100.0 * x, 1.0)};
  const std::vector<PolarBand> bands = residualStatistics(oneView(corners), points).at(0).bands;
  ASSERT_EQ(bands.size(), 3U);
  EXPECT_NEAR(bands[1].from_rad, 10.0 * M_PI / 180.0, 1e-12);
  EXPECT_NEAR(bands[1].to_rad, 20.0 * M_PI / 180.0, 1e-12);
  EXPECT_EQ(bands[0].num_corners, 2);
  EXPECT_NEAR(bands[0].rms_px, std::sqrt(13.0), 1e-12);
  EXPECT_EQ(bands[1].num_corners, 0);
  EXPECT_EQ(bands[1].rms_px, 0.0);
  EXPECT_EQ(bands[2].num_corners, 1);
  EXPECT_NEAR(bands[2].rms_px, 1.0, 1e-12);
}

TEST(ResidualStatistics, AreZeroForACameraThatSawNothing) {
  Solution solution = oneView({corner(0, 0.0, 0.0)});
  solution.rig.cameras.push_back(solution.rig.cameras[0]);
  const std::vector<CameraStatistics> statistics = residualStatistics(solution, {{0.0, 0.0, 0.0}, {1.0, 1.0, 0.0}});
  ASSERT_EQ(statistics.size(), 2U);
  EXPECT_EQ(statistics[1].num_corners, 0);
  EXPECT_TRUE(statistics[1].bands.empty());
}

TEST(ResidualStatistics, FollowTheBoardsWarp) {
  Solution solution = oneView({corner(0, 100.0, 0.0)});
  solution.board_warp_m = {-0.5, 0.0};  // the middle of the board comes half a metre closer
  const std::vector<Eigen::Vector3d> points = {{0.5, 0.0, 0.0}, {0.0, 0.0, 0.0}, {1.0, 1.0, 0.0}};
  EXPECT_NEAR(residualStatistics(solution, points).at(0).rms_px, 0.0, 1e-12);
}

TEST(ResidualStatistics, AgreeWithTheSolvesOwnStdev) {
  Random random(1);
  const Scene scene = test_support::simulateScene(rowOfCameras({"ds-none"}, random), {});
  const Solution solution = solve(noisyProblem(scene, 0.2, 5), {});
  const CameraStatistics statistics = residualStatistics(solution, scene.target_points).at(0);
  EXPECT_EQ(statistics.num_corners, solution.counts[0].used);
  const double num_measurements = 2.0 * statistics.num_corners;
  const double num_unknowns = 6.0 + 6.0 * static_cast<double>(scene.views.size());
  EXPECT_NEAR(statistics.rms_px * std::sqrt(0.5 * num_measurements / (num_measurements - num_unknowns)), solution.sigma_px,
              1e-9);
}

}  // namespace
}  // namespace tartan_calib::calibration
