#include "tartan_calib/report/camera_timing.h"

#include <gtest/gtest.h>

#include <cmath>

#include "moving_scene.h"

namespace tartan_calib::report {
namespace {

CameraTiming timingOf(const test_support::Scene& scene) {
  const pipeline::CalibrationResult result = solved(scene);
  const std::vector<CameraTiming> timings = cameraTimings(result, seenCorners(result));
  EXPECT_EQ(timings.size(), 1U);
  return timings.empty() ? CameraTiming{} : timings.front();
}

TEST(CameraTimingTest, FindsHowMuchLaterACameraSeesTheBoard) {
  for (const double delay_ms : {4.0, -4.0, 1.0}) {
    const CameraTiming timing = timingOf(movingScene(delay_ms));
    EXPECT_NEAR(timing.delay_ns * 1e-6, delay_ms, 0.05 * std::abs(delay_ms));
    EXPECT_GT(std::abs(timing.delay_ns), 6.0 * timing.delay_stdev_ns);
  }
}

TEST(CameraTimingTest, SeesNoDelayWhereThereIsNone) {
  const CameraTiming timing = timingOf(movingScene(0.0));
  EXPECT_LT(std::abs(timing.delay_ns), 4.0 * timing.delay_stdev_ns);
  EXPECT_LT(std::abs(timing.delay_ns), 0.1e6);
}

TEST(CameraTimingTest, TellsHowFarTheStampsAreApart) {
  test_support::Scene scene = movingScene(4.0);
  for (observation::View& view : scene.views) {
    view.cameras[1].stamp_ns += 4'000'000;
  }
  EXPECT_DOUBLE_EQ(timingOf(scene).median_stamp_ns, 4e6);
}

}  // namespace
}  // namespace tartan_calib::report
