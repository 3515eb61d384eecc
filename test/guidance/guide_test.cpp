#include "tartan_calib/guidance/guide.h"

#include <gtest/gtest.h>

#include <string>

#include "support/simulated_scene.h"
#include "tartan_calib/calibration/information.h"
#include "tartan_calib/guidance/information.h"

namespace tartan_calib::guidance {
namespace {

using geometry::Rigid3;
using test_support::Scene;

constexpr int kWidth_px = 800;
constexpr int kHeight_px = 600;

camera::Camera testCamera() {
  test_support::Random random(7);
  return test_support::randomCamera("ds-none", 2.0, kWidth_px, kHeight_px, random);
}

/// The board upright in front of the camera, its centre there, turned about the image's axes.
Rigid3 boardAt(const Eigen::Vector3d& centre_cam, double about_x_rad, double about_y_rad) {
  const auto points = target::cornerPoints(target::AprilGrid{});
  const Eigen::Vector3d centre = 0.5 * (points.front() + points.back());
  const Eigen::Quaterniond R = Eigen::AngleAxisd(about_y_rad, Eigen::Vector3d::UnitY()) *
                               Eigen::AngleAxisd(about_x_rad, Eigen::Vector3d::UnitX()) *
                               Eigen::AngleAxisd(M_PI, Eigen::Vector3d::UnitX());
  return Rigid3(R, centre_cam - R * centre);
}

/// What a camera sees of the board; the image itself is grey.
SeenImage seenImage(const camera::Camera& camera, const Rigid3& T_cam_target, std::int64_t stamp_ns, double blur_px = 0.8) {
  const auto view = test_support::visibleCorners(camera, target::cornerPoints(target::AprilGrid{}), T_cam_target, M_PI);
  return {0, stamp_ns, cv::Mat(kHeight_px, kWidth_px, CV_8UC1, cv::Scalar(128)), view.corners, blur_px};
}

class GuideTest : public testing::Test {
 protected:
  static GuideOptions options() {
    GuideOptions options;
    options.calibrate.models = {"ds-none"};
    options.calibrate.num_threads = 1;
    return options;
  }

  Decision show(const Rigid3& T_cam_target, double blur_px = 0.8) {
    last_ = seenImage(camera_, T_cam_target, ++stamp_ns_, blur_px);
    return guide_.offer({last_}).front();
  }

  std::string advice() const { return guide_.advise({last_}).text; }

  /// Tilted views from everywhere.
  void showAll(int num_views, unsigned seed) {
    test_support::SceneOptions scene_options;
    scene_options.num_views = num_views;
    scene_options.seed = seed;
    for (const Rigid3& T_rig_target : test_support::simulateScene(camera_, scene_options).T_rig_target) {
      show(T_rig_target);
    }
  }

  void solve() {
    const auto solve = guide_.nextSolve([] { return false; });
    ASSERT_TRUE(solve);
    const auto rig = (*solve)();
    ASSERT_TRUE(rig);
    guide_.adopt(*rig);
  }

  camera::Camera camera_ = testCamera();
  Guide guide_{target::AprilGrid{}, 1, options()};
  SeenImage last_;
  std::int64_t stamp_ns_ = 0;
};

TEST_F(GuideTest, AsksForTheBoardFirst) {
  guide_.offer({{0, 1, cv::Mat(kHeight_px, kWidth_px, CV_8UC1, cv::Scalar(128)), {}, {}}});
  EXPECT_EQ(advice(), "show the whole board");
}

TEST_F(GuideTest, ViewsThatAllFaceTheCameraNeedATilt) {
  for (const double x_m : {-0.35, 0.0, 0.35}) {
    for (const double y_m : {-0.2, 0.0, 0.2}) {
      EXPECT_EQ(show(boardAt({x_m, y_m, 0.6}, 0.0, 0.0)), Decision::kKept);
    }
  }
  EXPECT_NE(advice().find("tilt the board"), std::string::npos) << advice();
}

TEST_F(GuideTest, ViewsInTheLeftHalfAloneNeedTheRight) {
  for (const double tilt_rad : {-0.6, 0.6}) {
    for (const double y_m : {-0.25, 0.25}) {
      show(boardAt({-0.7, y_m, 0.7}, tilt_rad, 0.0));
      show(boardAt({-0.7, y_m, 0.7}, 0.0, tilt_rad));
    }
  }
  EXPECT_NE(advice().find("right"), std::string::npos) << advice();
}

TEST_F(GuideTest, DoesNotKeepWhatItHas) {
  EXPECT_EQ(show(boardAt({0.0, 0.0, 0.6}, 0.0, 0.0)), Decision::kKept);
  EXPECT_EQ(show(boardAt({0.005, 0.0, 0.6}, 0.0, 0.0)), Decision::kKnown);
  EXPECT_EQ(guide_.kept().size(), 1u);
}

TEST_F(GuideTest, TakesTheSharperOfTwoAlike) {
  show(boardAt({0.0, 0.0, 0.6}, 0.0, 0.0), 1.8);
  EXPECT_EQ(show(boardAt({0.005, 0.0, 0.6}, 0.0, 0.0), 0.7), Decision::kKeptInstead);
  EXPECT_EQ(guide_.kept().front().blur_px, 0.7);
}

TEST_F(GuideTest, DoesNotKeepBlurredImages) {
  EXPECT_EQ(show(boardAt({0.0, 0.0, 0.6}, 0.0, 0.0), 3.0), Decision::kBlurred);
  EXPECT_TRUE(guide_.kept().empty());
}

TEST_F(GuideTest, DoesNotMixImageSizes) {
  show(boardAt({0.0, 0.0, 0.6}, 0.0, 0.0));
  SeenImage other = last_;
  other.gray = cv::Mat(240, 320, CV_8UC1, cv::Scalar(128));
  EXPECT_EQ(guide_.offer({other}).front(), Decision::kOtherSize);
}

TEST_F(GuideTest, KeepsTheVeryPixels) {
  SeenImage image = seenImage(camera_, boardAt({0.0, 0.0, 0.6}, 0.0, 0.0), 1);
  cv::randu(image.gray, 0, 256);
  guide_.offer({image});
  EXPECT_EQ(cv::norm(guide_.kept().front().images.front().decode(), image.gray, cv::NORM_INF), 0.0);
}

TEST_F(GuideTest, SolvesFromTheKeptViewsAndThenAsksForWhatAddsMost) {
  showAll(12, 2);
  solve();
  ASSERT_TRUE(guide_.rig());
  const Advice before = guide_.advise({});
  ASSERT_TRUE(before.candidate);
  // Holding the board there is worth what was promised; its corners are the truth's, the promise is the solved model's.
  Eigen::MatrixXd known = priorInformation(*guide_.rig());
  for (const KeptView& kept : guide_.kept()) {
    known += kept.information;
  }
  EXPECT_EQ(show(before.candidate->T_rig_target), Decision::kKept);
  EXPECT_NEAR(gainBits(known, guide_.kept().back().information), before.gain_bits, 0.05 * before.gain_bits);
  EXPECT_LT(guide_.advise({}).gain_bits, before.gain_bits);
}

TEST_F(GuideTest, FollowingTheAdviceEndsInEnoughViews) {
  showAll(12, 2);
  solve();
  for (int i = 0; i < 60 && advice() != "enough views: calibrate"; ++i) {
    show(guide_.advise({}).candidate->T_rig_target);
  }
  EXPECT_EQ(advice(), "enough views: calibrate");
}

TEST_F(GuideTest, WhenFullItExchangesTheViewThatSaysLeast) {
  GuideOptions few = options();
  few.max_views = 10;
  guide_ = Guide(target::AprilGrid{}, 1, few);
  test_support::SceneOptions far;  // small boards say little
  far.num_views = 10;
  far.min_size_ratio = 0.2;
  far.max_size_ratio = 0.25;
  far.min_corners = 100;
  for (const Rigid3& T_rig_target : test_support::simulateScene(camera_, far).T_rig_target) {
    show(T_rig_target);
  }
  solve();
  const double before = guide_.advise({}).gain_bits;
  EXPECT_EQ(show(guide_.advise({}).candidate->T_rig_target), Decision::kKeptInstead);
  EXPECT_EQ(guide_.kept().size(), 10u);
  EXPECT_LT(guide_.advise({}).gain_bits, before);
}

TEST(GainBits, IsHalfTheLogOfTheDeterminantsRatio) {
  const Eigen::MatrixXd known = Eigen::Vector3d(1.0, 4.0, 9.0).asDiagonal();
  EXPECT_NEAR(gainBits(known, 3.0 * known), 3.0, 1e-12);  // 3 unknowns, each twice as certain
  EXPECT_EQ(gainBits(known, Eigen::MatrixXd::Zero(3, 3)), 0.0);
}

}  // namespace
}  // namespace tartan_calib::guidance
