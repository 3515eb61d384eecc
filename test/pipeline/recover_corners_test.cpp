#include "../../src/pipeline/recover_corners.h"

#include <gtest/gtest.h>

#include <atomic>
#include <opencv2/imgproc.hpp>

#include "board_stream.h"
#include "support/board_scene.h"

/// One camera's images in one round, its lens and the poses of some of them being known.
namespace tartan_calib::pipeline {
namespace {

using test_support::BoardPose;
using test_support::BoardScene;

const target::AprilGrid kGrid;
constexpr double kFocal_px = 220.0;
constexpr double kDistance_m = 0.5;

camera::Camera lens() { return test_support::fisheyeCamera(640, 560, kFocal_px); }

/// The board waved slowly.
BoardPose poseAt(double time) {
  return {kDistance_m, 0.3 + 0.03 * time, 0.4 + 0.05 * time, 0.1, -0.2 + 0.03 * time, 0.3 + 0.04 * time};
}

geometry::Rigid3 boardAt(double time) { return test_support::poseOf(kGrid, poseAt(time)); }

std::int64_t stampOf(std::size_t image) { return static_cast<std::int64_t>(image + 1) * kPeriod_ns; }

cv::Mat shoot(double time, bool has_thumb = false) {
  BoardScene scene(lens());
  const auto corners = scene.add(kGrid, poseAt(time));
  if (has_thumb) {
    const Eigen::Vector2d px = corners.at(30).px;
    cv::circle(scene.grey(), {static_cast<int>(px.x()), static_cast<int>(px.y())}, 20, 150.0F, cv::FILLED);
  }
  return scene.expose(0.6, 2.0);
}

class RecoverCornersTest : public ::testing::Test {
 protected:
  RecoverCornersTest() {
    solution.rig.cameras.resize(1);
    solution.rig.cameras[0].camera = lens();
  }

  void addImage(const cv::Mat& image) {
    images.push_back({stampOf(images.size()), [this, image] {
                        ++num_loads;
                        return image.clone();
                      }});
  }

  void solved(std::size_t image, const geometry::Rigid3& T_cam_target) {
    solution.views.push_back({stampOf(image), {{0, stampOf(image), {}}}});
    solution.T_rig_target.push_back(T_cam_target);
  }

  /// Returns how many images the round looked at.
  std::size_t runRound() {
    num_loads = 0;
    const BoardPoses poses(solution, 0);
    const std::vector<Eigen::Vector3d> flat_points = target::cornerPoints(kGrid);
    const std::vector<Eigen::Vector3d> points = calibration::warpedPoints(flat_points, solution.board_warp_m);
    const BoardShape shape{calibration::BoardBend(flat_points), solution.board_warp_m};
    const RoundStart start{solution, poses, points, shape};
    const detection::CornerRecovery recovery{kGrid};
    const ViewDetection no_views(lens(), kGrid, {}, {});
    const RoundSearch search{&recovery, no_views, 0.0, history};
    CalibrateOptions options;
    options.num_threads = 1;
    corners = recoverCorners(streamOf(images), 0, search, start, corners, options, {});
    return num_loads;
  }

  std::vector<observation::Corner> cornersIn(std::size_t image) const {
    for (const observation::CameraView& view : corners.images) {
      if (view.stamp_ns == stampOf(image)) {
        return view.corners;
      }
    }
    return {};
  }

  calibration::Solution solution;
  std::vector<StampedImage> images;
  std::atomic<std::size_t> num_loads{0};
  SearchHistory history;
  CameraCorners corners;
};

TEST_F(RecoverCornersTest, ImagesAreLookedAtAgainOncePredictionsMoveAndSoonerWhereCornersAreMissing) {
  addImage(shoot(0.0));
  addImage(shoot(1.0, true));
  const auto solve_moved_by = [this](double move_px) {
    solution.views.clear();
    solution.T_rig_target.clear();
    for (const std::size_t image : {0U, 1U}) {
      geometry::Rigid3 T_cam_target = boardAt(static_cast<double>(image));
      T_cam_target.translation.x() += move_px * kDistance_m / kFocal_px;
      solved(image, T_cam_target);
    }
  };
  solve_moved_by(0.0);
  EXPECT_EQ(runRound(), 2U);
  EXPECT_EQ(cornersIn(0).size(), 144U);
  EXPECT_LT(cornersIn(1).size(), 144U);
  EXPECT_EQ(runRound(), 0U);
  solve_moved_by(0.25);
  EXPECT_EQ(runRound(), 1U) << "the one with the thumb";
  solve_moved_by(1.2);
  EXPECT_EQ(runRound(), 2U);
  EXPECT_EQ(runRound(), 0U);
}

TEST_F(RecoverCornersTest, ImagesAreLookedAtAgainOnceTheBoardIsThoughtToBend) {
  addImage(shoot(0.0));
  solved(0, boardAt(0.0));
  EXPECT_EQ(runRound(), 1U);
  EXPECT_EQ(runRound(), 0U);
  solution.board_warp_m = Eigen::Vector2d(0.005, 0.0);
  EXPECT_EQ(runRound(), 1U);
  EXPECT_EQ(runRound(), 0U);
}

TEST_F(RecoverCornersTest, WhereNothingWasDetectedTheImagesNextInTimeSayWhereToLook) {
  for (const double time : {0.0, 1.0, 2.0}) {
    addImage(shoot(time));
  }
  solved(0, boardAt(0.0));
  runRound();
  EXPECT_TRUE(cornersIn(1).empty()) << "from one neighbour alone no pose is guessed";
  solved(2, boardAt(2.0));
  runRound();
  const std::vector<observation::Corner> found = cornersIn(1);
  EXPECT_EQ(found.size(), 144U);
  const auto truth = simulation::projectCorners(kGrid, lens(), boardAt(1.0));
  for (const observation::Corner& corner : found) {
    EXPECT_LT((corner.px - truth.at(static_cast<std::size_t>(corner.corner_id)).px).norm(), 0.2) << corner.corner_id;
  }
}

}  // namespace
}  // namespace tartan_calib::pipeline
