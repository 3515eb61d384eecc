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
    last = seenImage(camera, T_cam_target, ++stamp_ns, blur_px);
    return guide.offer({last}).front();
  }

  std::string advice() const { return guide.advise({last}).text; }

  /// Tilted views from everywhere.
  void showAll(int num_views, unsigned seed) {
    test_support::SceneOptions scene_options;
    scene_options.num_views = num_views;
    scene_options.seed = seed;
    for (const Rigid3& T_rig_target : test_support::simulateScene(camera, scene_options).T_rig_target) {
      show(T_rig_target);
    }
  }

  void solve() {
    const auto solve = guide.nextSolve([] { return false; });
    ASSERT_TRUE(solve);
    const auto rig = (*solve)();
    ASSERT_TRUE(rig);
    guide.adopt(*rig);
  }

  camera::Camera camera = testCamera();
  Guide guide{target::AprilGrid{}, 1, options()};
  SeenImage last;
  std::int64_t stamp_ns = 0;
};

TEST_F(GuideTest, AsksForTheBoardFirst) {
  guide.offer({{0, 1, cv::Mat(kHeight_px, kWidth_px, CV_8UC1, cv::Scalar(128)), {}, {}}});
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
  EXPECT_EQ(guide.kept().size(), 1u);
}

TEST_F(GuideTest, TakesTheSharperOfTwoAlike) {
  show(boardAt({0.0, 0.0, 0.6}, 0.0, 0.0), 1.8);
  EXPECT_EQ(show(boardAt({0.005, 0.0, 0.6}, 0.0, 0.0), 0.7), Decision::kKeptInstead);
  EXPECT_EQ(guide.kept().front().blur_px, 0.7);
}

TEST_F(GuideTest, DoesNotKeepBlurredImages) {
  EXPECT_EQ(show(boardAt({0.0, 0.0, 0.6}, 0.0, 0.0), 3.0), Decision::kBlurred);
  EXPECT_TRUE(guide.kept().empty());
}

TEST_F(GuideTest, DoesNotMixImageSizes) {
  show(boardAt({0.0, 0.0, 0.6}, 0.0, 0.0));
  SeenImage other = last;
  other.gray = cv::Mat(240, 320, CV_8UC1, cv::Scalar(128));
  EXPECT_EQ(guide.offer({other}).front(), Decision::kOtherSize);
}

TEST_F(GuideTest, KeepsTheVeryPixels) {
  SeenImage image = seenImage(camera, boardAt({0.0, 0.0, 0.6}, 0.0, 0.0), 1);
  cv::randu(image.gray, 0, 256);
  guide.offer({image});
  EXPECT_EQ(cv::norm(guide.kept().front().images.front().decode(), image.gray, cv::NORM_INF), 0.0);
}

TEST_F(GuideTest, SolvesFromTheKeptViewsAndThenAsksForWhatAddsMost) {
  showAll(12, 2);
  solve();
  ASSERT_TRUE(guide.rig());
  const Advice before = guide.advise({});
  ASSERT_TRUE(before.candidate);
  // Holding the board there is worth what was promised; its corners are the truth's, the promise is the solved model's.
  Eigen::MatrixXd known = priorInformation(*guide.rig());
  for (const KeptView& kept : guide.kept()) {
    known += kept.information;
  }
  EXPECT_EQ(show(before.candidate->T_rig_target), Decision::kKept);
  EXPECT_NEAR(gainBits(known, guide.kept().back().information), before.gain_bits, 0.05 * before.gain_bits);
  EXPECT_LT(guide.advise({}).gain_bits, before.gain_bits);
}

TEST_F(GuideTest, FollowingTheAdviceEndsInEnoughViews) {
  showAll(12, 2);
  solve();
  for (int i = 0; i < 60 && advice() != "enough views: calibrate"; ++i) {
    show(guide.advise({}).candidate->T_rig_target);
  }
  EXPECT_EQ(advice(), "enough views: calibrate");
}

TEST_F(GuideTest, AdvisedViewsTellMoreThanWavedOnes) {
  constexpr int kNumMore = 8;
  showAll(12, 2);
  solve();
  test_support::SceneOptions waved;
  waved.num_views = kNumMore;
  waved.seed = 3;
  const calibration::Rig rig = *guide.rig();
  Eigen::MatrixXd known = priorInformation(rig);
  for (const KeptView& kept : guide.kept()) {
    known += kept.information;
  }
  Eigen::MatrixXd by_waving = known;
  const Scene scene = test_support::simulateScene(camera, waved);
  for (std::size_t i = 0; i < scene.views.size(); ++i) {
    by_waving += calibration::viewInformation(rig, scene.target_points, scene.views[i], scene.T_rig_target[i]);
  }
  Eigen::MatrixXd by_advice = known;
  for (int i = 0; i < kNumMore; ++i) {
    show(guide.advise({}).candidate->T_rig_target);
    by_advice += guide.kept().back().information;
  }
  EXPECT_GT(gainBits(known, by_advice - known), 1.5 * gainBits(known, by_waving - known));
}

TEST_F(GuideTest, WhenFullItExchangesTheViewThatSaysLeast) {
  GuideOptions few = options();
  few.max_views = 10;
  guide = Guide(target::AprilGrid{}, 1, few);
  test_support::SceneOptions far;  // small boards say little
  far.num_views = 10;
  far.min_size_ratio = 0.2;
  far.max_size_ratio = 0.25;
  far.min_corners = 100;
  for (const Rigid3& T_rig_target : test_support::simulateScene(camera, far).T_rig_target) {
    show(T_rig_target);
  }
  solve();
  const double before = guide.advise({}).gain_bits;
  EXPECT_EQ(show(guide.advise({}).candidate->T_rig_target), Decision::kKeptInstead);
  EXPECT_EQ(guide.kept().size(), 10u);
  EXPECT_LT(guide.advise({}).gain_bits, before);
}

TEST(RigGuide, AsksForTheBoardInTwoCamerasAtOnce) {
  GuideOptions options;
  options.calibrate.models = {"ds-none", "ds-none"};
  Guide guide(target::AprilGrid{}, 2, options);
  SeenImage image = seenImage(testCamera(), boardAt({0.0, 0.0, 0.6}, 0.0, 0.0), 1);
  for (int camera_index = 0; camera_index < 2; ++camera_index) {  // never both
    image.camera_index = camera_index;
    image.stamp_ns = camera_index;
    EXPECT_EQ(guide.offer({image}).front(), Decision::kKept);
  }
  EXPECT_EQ(guide.advise({}).text, "show the board to cam0 and cam1 at the same time");
}

TEST(RigGuide, SaysOfEachImageWhatBecameOfIt) {
  GuideOptions options;
  options.calibrate.models = {"ds-none", "ds-none"};
  Guide guide(target::AprilGrid{}, 2, options);
  const SeenImage image = seenImage(testCamera(), boardAt({0.0, 0.0, 0.6}, 0.0, 0.0), 1);
  SeenImage blurred = image;
  blurred.camera_index = 1;
  blurred.blur_px = 5.0;
  EXPECT_EQ(guide.offer({image, blurred}), (std::vector<Decision>{Decision::kKept, Decision::kBlurred}));
}

TEST(GainBits, IsHalfTheLogOfTheDeterminantsRatio) {
  const Eigen::MatrixXd known = Eigen::Vector3d(1.0, 4.0, 9.0).asDiagonal();
  EXPECT_NEAR(gainBits(known, 3.0 * known), 3.0, 1e-12);  // 3 unknowns, each twice as certain
  EXPECT_EQ(gainBits(known, Eigen::MatrixXd::Zero(3, 3)), 0.0);
}

}  // namespace
}  // namespace tartan_calib::guidance
