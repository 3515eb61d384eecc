#include "tartan_calib/guidance/board_shape.h"

#include <gtest/gtest.h>

#include "support/simulated_scene.h"
#include "tartan_calib/guidance/board_candidates.h"

namespace tartan_calib::guidance {
namespace {

using geometry::Rigid3;

constexpr double kTilt_rad = 0.7;

camera::Camera pinholeCamera() {
  return {camera::startModel(camera::modelByName("pinhole-radtan"), 500.0, {399.5, 299.5}), 800, 600};
}

std::vector<Eigen::Vector3d> boardPoints() { return target::cornerPoints(target::AprilGrid{}); }

/// In front of the camera, upright, then turned about the image's axes and about the line of sight.
Rigid3 boardPose(const Eigen::Vector3d& turn_rad, double roll_rad) {
  const auto points = boardPoints();
  const Eigen::Vector3d centre = 0.5 * (points.front() + points.back());
  const Eigen::Quaterniond R = geometry::expRotation(turn_rad) * Eigen::AngleAxisd(M_PI, Eigen::Vector3d::UnitX()) *
                               Eigen::AngleAxisd(roll_rad, Eigen::Vector3d::UnitZ());
  return Rigid3(R, Eigen::Vector3d(0.0, 0.0, 1.0) - R * centre);
}

/// A turn about x by a positive angle lowers the upper edge's depth: the board faces down. About y: it faces left.
const std::vector<std::pair<Eigen::Vector3d, Tilt>> kTurns = {{{kTilt_rad, 0.0, 0.0}, Tilt::kDown},
                                                              {{-kTilt_rad, 0.0, 0.0}, Tilt::kUp},
                                                              {{0.0, kTilt_rad, 0.0}, Tilt::kLeft},
                                                              {{0.0, -kTilt_rad, 0.0}, Tilt::kRight},
                                                              {{0.0, 0.0, 0.0}, Tilt::kNone}};

TEST(BoardShape, TiltIsSeenInTheImageAloneHoweverTheBoardIsRolled) {
  for (const double roll_rad : {0.0, 1.0, 2.0, 4.0}) {
    for (const auto& [turn_rad, tilt] : kTurns) {
      const auto view = test_support::visibleCorners(pinholeCamera(), boardPoints(), boardPose(turn_rad, roll_rad), M_PI);
      const auto shape = boardShape(view.corners, boardPoints());
      ASSERT_TRUE(shape);
      EXPECT_EQ(shape->tilt, tilt) << roll_rad << " " << turn_rad.transpose();
    }
  }
}

TEST(BoardPlacement, AgreesWithTheShapeInTheImage) {
  const calibration::RigCamera rig_camera{pinholeCamera(), Rigid3()};
  for (const auto& [turn_rad, tilt] : kTurns) {
    const auto placement = boardPlacement(rig_camera, boardPoints(), boardPose(turn_rad, 0.5));
    ASSERT_TRUE(placement);
    EXPECT_EQ(placement->tilt, tilt) << turn_rad.transpose();
    EXPECT_NEAR(placement->distance_m, 1.0, 1e-9);
    EXPECT_NEAR((placement->centre_px - Eigen::Vector2d(399.5, 299.5)).norm(), 0.0, 1e-6);
  }
}

TEST(BoardShape, SizeIsThatOfTheWholeBoardThoughPartsAreHidden) {
  const double extent_m = boardPoints().back().x() - boardPoints().front().x();
  auto corners = test_support::visibleCorners(pinholeCamera(), boardPoints(), boardPose({0.0, 0.0, 0.0}, 0.0), M_PI).corners;
  corners.resize(corners.size() / 2);
  const auto shape = boardShape(corners, boardPoints());
  ASSERT_TRUE(shape);
  EXPECT_NEAR(shape->size_px, 500.0 * extent_m, 0.01 * shape->size_px);
}

TEST(BoardShape, IsUnknownFromCornersOnALine) {
  std::vector<observation::Corner> corners;
  for (int id = 0; id < 12; ++id) {
    corners.push_back({id, {10.0 * id, 20.0}});
  }
  EXPECT_FALSE(boardShape(corners, boardPoints()));
}

TEST(Region, CoversTheImageAndWhatIsBeyond) {
  EXPECT_EQ(regionName(regionOf({0.0, 0.0}, 900, 600)), "upper left corner");
  EXPECT_EQ(regionName(regionOf({450.0, 300.0}, 900, 600)), "centre");
  EXPECT_EQ(regionName(regionOf({899.0, 300.0}, 900, 600)), "right side");
  EXPECT_EQ(regionName(regionOf({-50.0, 5000.0}, 900, 600)), "lower left corner");
}

}  // namespace
}  // namespace tartan_calib::guidance
