#include "tartan_calib/simulation/recording.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstddef>

#include "tartan_calib/error.h"
#include "tartan_calib/simulation/lens.h"
#include "tartan_calib/simulation/true_corner.h"

namespace tartan_calib::simulation {
namespace {

RecordingOptions options(const std::string& lens) {
  RecordingOptions options;
  LensRequest request;
  request.lens = lens;
  options.cameras = {makeLens(request)};
  return options;
}

std::vector<TrueCorner> seenBy(const Scene& scene, std::size_t camera, const SceneFrame& frame) {
  return projectCorners(scene.target, scene.cameras[camera].camera, scene.cameras[camera].T_cam_rig * frame.T_rig_target);
}

TEST(MakeRecording, coversTheFieldOfViewToItsRim) {
  const Scene scene = makeRecording(options("fisheye190"));
  ASSERT_EQ(scene.frames.size(), 60U);
  constexpr double kBandRad = 10.0 * M_PI / 180.0;
  std::array<int, 10> corners_in_band{};
  for (const SceneFrame& frame : scene.frames) {
    const std::vector<TrueCorner> corners = seenBy(scene, 0, frame);
    EXPECT_GE(corners.size(), 20U);
    for (const TrueCorner& corner : corners) {
      const Eigen::Vector3d ray = *camera::unproject(scene.cameras[0].camera.model, corner.px);
      const double polar_rad = std::acos(ray.z());
      if (polar_rad < 0.5 * 190.0 * M_PI / 180.0) {
        ++corners_in_band.at(static_cast<std::size_t>(polar_rad / kBandRad));
      }
    }
  }
  for (std::size_t band = 0; band < 10; ++band) {
    EXPECT_GE(corners_in_band.at(band), 80) << band * 10 << " degrees";
  }
}

TEST(MakeRecording, movesSmoothlyAndTurnsTheBoardAllWays) {
  const Scene scene = makeRecording(options("fisheye190"));
  double most_tilted_rad = 0.0;
  double least_tilted_rad = M_PI;
  for (std::size_t i = 1; i < scene.frames.size(); ++i) {
    const geometry::Rigid3& T = scene.frames[i].T_rig_target;
    const Eigen::Vector3d centre(0.32, 0.32, 0.0);
    const double step_m = (T * centre - scene.frames[i - 1].T_rig_target * centre).norm();
    EXPECT_LT(step_m, 0.5) << "in a quarter of a second, before frame " << i;
    EXPECT_EQ(scene.frames[i].stamp_ns - scene.frames[i - 1].stamp_ns, 250'000'000);
    const Eigen::Vector3d normal = T.rotation * Eigen::Vector3d::UnitZ();
    const double tilt_rad = std::acos(-normal.dot((T * centre).normalized()));
    most_tilted_rad = std::max(most_tilted_rad, tilt_rad);
    least_tilted_rad = std::min(least_tilted_rad, tilt_rad);
  }
  EXPECT_GT(most_tilted_rad, 0.6);
  EXPECT_LT(least_tilted_rad, 0.15);
}

TEST(MakeRecording, blursAndCoversAsManyViewsAsAskedFor) {
  RecordingOptions asked = options("gopro150");
  asked.blurred_ratio = 0.25;
  asked.max_blur_px = 6.0;
  asked.hand_ratio = 0.4;
  const Scene scene = makeRecording(asked);
  int num_blurred = 0;
  int num_hands = 0;
  const std::vector<Eigen::Vector3d> points = target::cornerPoints(scene.target);
  for (const SceneFrame& frame : scene.frames) {
    num_hands += frame.hand ? 1 : 0;
    if (frame.motion.isZero()) {
      continue;
    }
    ++num_blurred;
    double path_px = 0.0;
    const std::vector<TrueCorner> corners = seenBy(scene, 0, frame);
    for (const TrueCorner& corner : corners) {
      const Eigen::Vector3d& p = points[static_cast<std::size_t>(corner.corner_id)];
      const auto at = [&](double s) {
        return *camera::project(scene.cameras[0].camera.model,
                                frame.T_rig_target * geometry::expRigid(s * frame.motion) * p);
      };
      path_px += (at(0.5) - at(-0.5)).norm() / static_cast<double>(corners.size());
    }
    EXPECT_GT(path_px, 0.5);
    EXPECT_LT(path_px, 6.6) << "a tenth for the path's bend";
  }
  EXPECT_EQ(num_blurred, 15);
  EXPECT_EQ(num_hands, 24);
}

TEST(MakeRecording, showsTheBoardToEveryCameraInTurnAndToNeighboursAtOnce) {
  RecordingOptions asked = options("pinhole70");
  asked.cameras = makeRig({asked.cameras[0], asked.cameras[0], asked.cameras[0]}, 0.1, 55.0 * M_PI / 180.0, 3);
  const Scene scene = makeRecording(asked);
  std::array<int, 3> seen{};
  int neighbours = 0;
  int outer_pair = 0;
  for (const SceneFrame& frame : scene.frames) {
    std::array<bool, 3> sees{};
    for (std::size_t k = 0; k < 3; ++k) {
      sees.at(k) = seenBy(scene, k, frame).size() >= 8;
      seen.at(k) += sees.at(k) ? 1 : 0;
    }
    neighbours += (sees[0] && sees[1]) || (sees[1] && sees[2]) ? 1 : 0;
    outer_pair += sees[0] && sees[2] ? 1 : 0;
  }
  EXPECT_GE(*std::min_element(seen.begin(), seen.end()), 20);
  EXPECT_GE(neighbours, 4);
  EXPECT_EQ(outer_pair, 0) << "these two look 110 degrees apart";
}

TEST(MakeRecording, refusesOptionsWithoutSense) {
  RecordingOptions none = options("fisheye190");
  none.num_frames = 0;
  EXPECT_THROW(makeRecording(none), InputError);
  RecordingOptions ratio = options("fisheye190");
  ratio.hand_ratio = 1.5;
  EXPECT_THROW(makeRecording(ratio), InputError);
  RecordingOptions blind;
  EXPECT_THROW(makeRecording(blind), InputError);
}

TEST(MakeRecording, keepsTheBoardAsNearAndAsUprightAsAsked) {
  RecordingOptions near = options("fisheye190");
  near.reach_ratio = 0.1;
  near.max_tilt_rad = 0.02;
  const Eigen::Vector3d centre(0.32, 0.32, 0.0);
  for (const SceneFrame& frame : makeRecording(near).frames) {
    const Eigen::Vector3d ray = (frame.T_rig_target * centre).normalized();
    EXPECT_LT(std::acos(ray.z()), 0.25) << "of 1.66 rad at the rim";
    EXPECT_LT(std::acos(-(frame.T_rig_target.rotation * Eigen::Vector3d::UnitZ()).dot(ray)), 0.06);
  }
}

TEST(MakeRecording, showsACameraWithADelayTheBoardLater) {
  const RecordingOptions on_time = options("fisheye190");
  const Scene scene = makeRecording(on_time);
  SceneCamera late = scene.cameras[0];
  late.delay_s = 1.0 / on_time.rate_hz;
  for (std::size_t i = 0; i + 1 < scene.frames.size(); ++i) {
    const geometry::Rigid3 difference = boardPose(late, scene.frames[i]).inverse() * scene.frames[i + 1].T_rig_target;
    EXPECT_LT(geometry::logRigid(difference).norm(), 1e-9) << "frame " << i;
  }
}

}  // namespace
}  // namespace tartan_calib::simulation
