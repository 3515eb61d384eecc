#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "recovery_score.h"
#include "tartan_calib/detection/corner_recovery.h"
#include "tartan_calib/simulation/board_layer.h"

/// Corners of the board that something else hides are not reported.
namespace tartan_calib::detection {
namespace {

using test_support::BoardPose;
using test_support::BoardScene;
using test_support::kDegree;

const target::AprilGrid kGrid;
const BoardPose kPose{0.5, 30.0 * kDegree, 0.4, 10.0 * kDegree, -15.0 * kDegree, 20.0 * kDegree};

camera::Camera fisheye() { return test_support::fisheyeCamera(1000, 1000, 280.0); }

BoardMap mapOf(const BoardPose& pose) { return flatBoardMap(fisheye(), test_support::poseOf(kGrid, pose)); }

std::set<int> ids(const std::vector<observation::Corner>& corners) {
  std::set<int> result;
  for (const observation::Corner& corner : corners) {
    result.insert(corner.corner_id);
  }
  return result;
}

/// Light that a lamp behind the camera adds: 255 and more within `radius_px`, fading out around.
void addGlare(const Eigen::Vector2d& centre_px, double radius_px, cv::Mat1f& grey) {
  constexpr double kPeakGrey = 2000.0;
  const double sigma_px = radius_px / std::sqrt(2.0 * std::log(kPeakGrey / 255.0));
  for (int y = 0; y < grey.rows; ++y) {
    for (int x = 0; x < grey.cols; ++x) {
      const double squared = (Eigen::Vector2d(x, y) - centre_px).squaredNorm();
      grey(y, x) += static_cast<float>(kPeakGrey * std::exp(-0.5 * squared / (sigma_px * sigma_px)));
    }
  }
}

TEST(CoveredCornersTest, GlareHidesCornersAndMakesNoFalseOnes) {
  constexpr double kRadius_px = 35.0;
  constexpr double kClear = 2.0;  // of the radius: little glare beyond
  for (const std::size_t lit : {40U, 66U, 77U, 100U}) {
    BoardScene scene(fisheye());
    const auto truth = scene.add(kGrid, kPose);
    const Eigen::Vector2d lit_px = truth.at(lit).px;
    addGlare(lit_px, kRadius_px, scene.grey());
    const auto corners = CornerRecovery(kGrid).recover(scene.expose(0.7, 2.0), mapOf(kPose));
    const std::set<int> found = ids(corners);
    EXPECT_EQ(recoveryScore(corners, truth).wrong, 0) << lit;
    for (const simulation::TrueCorner& corner : truth) {
      const double distance_px = (corner.px - lit_px).norm();
      if (distance_px < kRadius_px || distance_px > kClear * kRadius_px) {
        EXPECT_EQ(found.count(corner.corner_id) > 0, distance_px > kRadius_px) << corner.corner_id << ", glare at " << lit;
      }
    }
  }
}

/// Of the places of corners, those that the sheet of a board covers.
std::set<int> coveredBy(const target::Target& board, const geometry::Rigid3& T_cam_board,
                        const std::vector<simulation::TrueCorner>& corners) {
  const simulation::BoardLayer layer =
      simulation::drawBoard(simulation::boardPattern(board, BoardScene::kMargin_m), fisheye(), T_cam_board);
  std::set<int> covered;
  for (const simulation::TrueCorner& corner : corners) {
    const cv::Point pixel(static_cast<int>(std::lround(corner.px.x())), static_cast<int>(std::lround(corner.px.y())));
    if (layer.window.contains(pixel) && layer.sheet(pixel - layer.window.tl()) > 0.5F) {
      covered.insert(corner.corner_id);
    }
  }
  return covered;
}

TEST(CoveredCornersTest, CornersBehindASecondBoardAreNotFoundOnThatOne) {
  target::AprilGrid second;
  second.code_offset = 40;
  for (const double roll_rad : {20.0 * kDegree, 110.0 * kDegree, 35.0 * kDegree, 0.0}) {
    for (const double aside_rad : {35.0 * kDegree, -30.0 * kDegree}) {
      BoardPose pose = kPose;
      pose.distance_m = 0.45;
      pose.polar_rad += aside_rad;
      pose.roll_rad = roll_rad;
      BoardScene scene(fisheye());
      const auto truth = scene.add(kGrid, kPose);
      scene.add(second, pose);
      const std::set<int> covered = coveredBy(second, test_support::poseOf(second, pose), truth);
      EXPECT_GT(covered.size(), 70U);
      const auto corners = CornerRecovery(kGrid).recover(scene.expose(0.7, 2.0), mapOf(kPose));
      EXPECT_EQ(recoveryScore(corners, truth).wrong, 0);
      EXPECT_GE(static_cast<double>(corners.size()), 0.9 * static_cast<double>(truth.size() - covered.size()));
      for (const int id : ids(corners)) {
        EXPECT_EQ(covered.count(id), 0U) << "corner " << id << ", roll " << roll_rad << ", aside " << aside_rad;
      }
    }
  }
}

/// From the frame of a board of 3x3 tags to that of the target, so that its tags lie on those from (row, col) on, turned by
/// quarters about its middle.
geometry::Rigid3 ontoLattice(int row, int col, int quarter_turns) {
  const double pitch_m = (1.0 + kGrid.tag_spacing_ratio) * kGrid.tag_size_m;
  const double middle_m = pitch_m + 0.5 * kGrid.tag_size_m;
  const Eigen::Vector3d middle(middle_m, middle_m, 0.0);
  const Eigen::Quaterniond turn(Eigen::AngleAxisd(quarter_turns * 90.0 * kDegree, Eigen::Vector3d::UnitZ()));
  return {turn, pitch_m * Eigen::Vector3d(col, row, 0.0) + middle - turn * middle};
}

TEST(CoveredCornersTest, CornersUnderTheSameCornersOfOtherTagsAreNotFound) {
  struct View {
    double distance_m;
    double blur_px;
  };
  constexpr int kNumBoards = 12;
  for (const View& view : {View{0.5, 0.7}, View{0.5, 1.5}, View{1.0, 0.7}, View{1.0, 1.5}}) {
    BoardPose pose = kPose;
    pose.distance_m = view.distance_m;
    const geometry::Rigid3 T_cam_target = test_support::poseOf(kGrid, pose);
    for (int k = 0; k < kNumBoards; ++k) {
      const bool has_tags_of_the_target = k == kNumBoards - 1;  // in other places
      target::AprilGrid second = kGrid;
      second.tag_rows = second.tag_cols = 3;
      second.code_offset = has_tags_of_the_target ? 0 : 40 * (k + 1);
      const geometry::Rigid3 T_cam_second = T_cam_target * ontoLattice(k % 4, 1 + k / 4, k % 4);
      BoardScene scene(fisheye());
      const auto truth = scene.add(kGrid, pose);
      scene.add(simulation::boardPattern(second, BoardScene::kMargin_m), second, T_cam_second);
      const std::set<int> covered = coveredBy(second, T_cam_second, truth);
      EXPECT_GE(covered.size(), 36U);
      const cv::Mat image = scene.expose(view.blur_px, 2.0);
      const auto corners = CornerRecovery(kGrid).recover(image, flatBoardMap(fisheye(), T_cam_target));
      EXPECT_GE(static_cast<double>(corners.size()), 0.85 * static_cast<double>(truth.size() - covered.size()));
      for (const int id : ids(corners)) {
        EXPECT_EQ(covered.count(id), 0U) << "corner " << id << ", board " << k << ", " << view.distance_m << " m, blur "
                                         << view.blur_px << " px";
      }
    }
  }
}

}  // namespace
}  // namespace tartan_calib::detection
