#include <gtest/gtest.h>

#include "recovery_score.h"
#include "tartan_calib/detection/corner_recovery.h"
#include "tartan_calib/median.h"

/// What the choices of refinement do to recovered corners.
namespace tartan_calib::detection {
namespace {

using test_support::BoardPose;
using test_support::kDegree;

const target::AprilGrid kGrid;

struct Trial {
  cv::Mat image;
  BoardMap map;
  std::vector<simulation::TrueCorner> truth;

  RecoveryScore with(const RecoveryOptions& options) const {
    return recoveryScore(CornerRecovery(kGrid, options).recover(image, map), truth);
  }
};

Trial makeTrial(const BoardPose& pose, double noise_grey) {
  test_support::BoardScene scene(test_support::fisheyeCamera(1000, 1000, 280.0));
  Trial trial;
  trial.truth = scene.add(kGrid, pose);
  trial.image = scene.expose(0.7, noise_grey);
  trial.map = flatBoardMap(scene.camera(), test_support::poseOf(kGrid, pose));
  return trial;
}

/// Bent lines and squares of all shapes, towards the rim of a 200-degree fisheye.
const Trial& tiltedAtTheRim() {
  static const Trial trial = makeTrial({0.45, 65.0 * kDegree, 0.4, 25.0 * kDegree, -30.0 * kDegree, 20.0 * kDegree}, 2.0);
  return trial;
}

RecoveryOptions refineBy(Refinement refinement) {
  RecoveryOptions options;
  options.refinement = refinement;
  return options;
}

RecoveryOptions symmetry(double window) {
  RecoveryOptions options = refineBy(Refinement::kSymmetry);
  options.symmetry_window = window;
  return options;
}

RecoveryOptions adaptive(const AdaptiveWindowOptions& window) {
  RecoveryOptions options = refineBy(Refinement::kAdaptive);
  options.adaptive_window = window;
  return options;
}

TEST(RecoveryRefinementTest, SymmetryIsBetterThanAnAdaptiveWindowAndThatThanAFixedOne) {
  const RecoveryScore by_symmetry = tiltedAtTheRim().with(refineBy(Refinement::kSymmetry));
  const RecoveryScore by_adaptive = tiltedAtTheRim().with(refineBy(Refinement::kAdaptive));
  const RecoveryScore by_fixed = tiltedAtTheRim().with(refineBy(Refinement::kFixed));
  for (const RecoveryScore& score : {by_symmetry, by_adaptive, by_fixed}) {
    EXPECT_EQ(score.found, score.expected);
    EXPECT_EQ(score.wrong, 0);
  }
  EXPECT_LT(by_symmetry.median_px, 0.5 * by_adaptive.median_px);
  EXPECT_LT(by_adaptive.median_px, by_fixed.median_px);
}

TEST(RecoveryRefinementTest, OneCornerIsRefinedAsAllAre) {
  const Eigen::Vector2d beside_px(0.2, -0.15);
  struct Case {
    Refinement refinement;
    double last_step_px;  // where the iteration may end beside where it would
  };
  for (const Case& one :
       {Case{Refinement::kSymmetry, 0.005}, Case{Refinement::kAdaptive, 0.06}, Case{Refinement::kFixed, 0.2}}) {
    const CornerRecovery recovery(kGrid, refineBy(one.refinement));
    std::vector<double> distances_px;
    for (const observation::Corner& corner : recovery.recover(tiltedAtTheRim().image, tiltedAtTheRim().map)) {
      const auto refined =
          recovery.refine(tiltedAtTheRim().image, tiltedAtTheRim().map, {corner.corner_id, corner.px + beside_px});
      ASSERT_TRUE(refined) << corner.corner_id;
      distances_px.push_back((refined->px - corner.px).norm());
    }
    EXPECT_GT(distances_px.size(), 100U);
    EXPECT_LT(upperMedian(distances_px), one.last_step_px);
  }
}

TEST(RecoveryRefinementTest, TheBestWindowForSymmetryReachesAsFarAsTheBoardIsSymmetric) {
  const RecoveryScore half = tiltedAtTheRim().with(symmetry(0.4));
  const RecoveryScore almost_all = tiltedAtTheRim().with(symmetry(0.9));
  const RecoveryScore into_payload = tiltedAtTheRim().with(symmetry(1.5));  // the paper's
  EXPECT_LT(almost_all.median_px, 0.015);
  EXPECT_GT(half.median_px, 1.4 * almost_all.median_px) << "fewer pixels, more noise";
  EXPECT_GT(into_payload.median_px, 10.0 * almost_all.median_px);
}

TEST(RecoveryRefinementTest, ALargeAdaptiveWindowIsBestWhereCornersAreFarApart) {
  const Trial near = makeTrial({0.3, 10.0 * kDegree, 0.4, 10.0 * kDegree, -15.0 * kDegree, 20.0 * kDegree}, 4.0);
  const double adaptive_px = near.with(adaptive({})).median_px;
  EXPECT_LT(1.4 * adaptive_px, near.with(adaptive({0.4, 2, 2})).median_px) << "the largest allowed window";
  EXPECT_LT(1.4 * adaptive_px, near.with(adaptive({0.1, 2, 8})).median_px) << "the share of the distance";
  EXPECT_LT(1.1 * adaptive_px, near.with(refineBy(Refinement::kFixed)).median_px);
}

TEST(RecoveryRefinementTest, AnAdaptiveWindowThatReachesOtherCornersLosesThisOne) {
  const Trial far = makeTrial({1.2, 20.0 * kDegree, 0.4, 10.0 * kDegree, -15.0 * kDegree, 20.0 * kDegree}, 1.0);
  const RecoveryScore within = far.with(adaptive({}));
  EXPECT_EQ(within.found, within.expected);
  EXPECT_LT(within.median_px, 0.1);
  EXPECT_EQ(far.with(adaptive({0.4, 8, 8})).found, 0) << "the smallest allowed window";
}

}  // namespace
}  // namespace tartan_calib::detection
