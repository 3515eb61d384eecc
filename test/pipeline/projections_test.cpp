#include <gtest/gtest.h>

#include <set>

#include "wide_recording.h"

namespace tartan_calib::pipeline {
namespace {

using test_support::kDegree;

constexpr double kFalse_px = 2.0;

/// Pixels of these views are about those of the images.
constexpr ViewSize kSize{90.0 * kDegree, 90.0 * kDegree, 500, 500};

Projections cube() {
  const auto faces = cubeViews(kSize);
  return {{faces.begin(), faces.end()}, std::nullopt};
}

using Filter = detection::CornerFilter;

CalibrationResult run(const Projections& projections, int max_rounds, int num_threads = 0, Filter filter = Filter::kImage) {
  CalibrateOptions options;
  options.models = {"ds-none"};
  options.max_rounds = max_rounds;
  options.recovery.filter = filter;
  options.num_threads = num_threads;
  options.projections = projections;
  return calibrate({wideStream()}, target::AprilGrid(), options);
}

struct Score {
  int found = 0;
  int wrong = 0;
  int repeated = 0;
};

Score scoreOf(const CalibrationResult& result) {
  Score score;
  const std::vector<CameraCorners> cameras = observedCorners(result);
  for (const observation::CameraView& image : cameras[0].images) {
    const auto index = static_cast<std::size_t>((image.stamp_ns - kWideFirst_ns) / kWidePeriod_ns);
    const geometry::Rigid3 T_cam_target = test_support::poseOf(target::AprilGrid(), widePose(index));
    const auto points = target::cornerPoints(target::AprilGrid());
    std::set<int> ids;
    for (const observation::Corner& corner : image.corners) {
      const auto px = camera::project(wideCamera().model, T_cam_target * points[static_cast<std::size_t>(corner.corner_id)]);
      const bool is_right = px && (*px - corner.px).norm() < kFalse_px;
      score.found += is_right ? 1 : 0;
      score.wrong += is_right ? 0 : 1;
      score.repeated += ids.insert(corner.corner_id).second ? 0 : 1;
    }
  }
  return score;
}

class ProjectionsTest : public testing::TestWithParam<Projections> {};

TEST_P(ProjectionsTest, FindCornersThatDetectionMissedAndNoneThatAreNotThere) {
  const Score before = scoreOf(run({}, 0));
  const CalibrationResult result = run(GetParam(), 0);
  const Score after = scoreOf(result);
  EXPECT_GT(after.found, before.found);
  EXPECT_EQ(after.wrong, 0);
  EXPECT_EQ(after.repeated, 0);
  ASSERT_EQ(result.rounds.size(), 1U);
  EXPECT_EQ(result.rounds[0].lost, 0);
  EXPECT_LT(result.cameras[0].statistics.rms_px, 0.1);
}

TEST_P(ProjectionsTest, CombineWithTheRounds) {
  const Score score = scoreOf(run(GetParam(), 1));
  EXPECT_EQ(score.wrong, 0);
  EXPECT_EQ(score.repeated, 0);
}

/// Quadrilaterals need straight sides, so that at the rim there is something left to find.
TEST_P(ProjectionsTest, AddWhatTheRoundsMiss) {
  const Score without = scoreOf(run({}, 1, 0, Filter::kQuads));
  const Score with = scoreOf(run(GetParam(), 1, 0, Filter::kQuads));
  EXPECT_GT(with.found, without.found);
  EXPECT_EQ(with.wrong, 0);
  EXPECT_EQ(with.repeated, 0);
}

INSTANTIATE_TEST_SUITE_P(Views, ProjectionsTest, testing::Values(cube(), Projections{{}, kSize}),
                         [](const auto& view) { return view.param.rectified ? "Rectified" : "Cube"; });

TEST(Projections, GiveTheSameWhateverTheThreads) {
  const CalibrationResult one = run(cube(), 0, 1);
  const CalibrationResult three = run(cube(), 0, 3);
  EXPECT_EQ(camera::parameters(one.solution.rig.cameras[0].camera.model),
            camera::parameters(three.solution.rig.cameras[0].camera.model));
}

}  // namespace
}  // namespace tartan_calib::pipeline
