#include <gtest/gtest.h>

#include <algorithm>
#include <opencv2/imgcodecs.hpp>

#include "support/board_scene.h"
#include "support/test_data.h"
#include "tartan_calib/detection/target_detector.h"

namespace tartan_calib::detection {
namespace {

using test_support::BoardPose;
using test_support::BoardScene;
using test_support::kDegree;

/// How a detection compares with the corners that were drawn.
struct Score {
  int found = 0;
  int wrong = 0;  ///< further than 1 px from the truth, or not drawn
  double median_error_px = 0.0;
};

Score score(const Detection& detection, const std::vector<simulation::TrueCorner>& truth) {
  std::vector<double> errors_px;
  Score result;
  for (const observation::Corner& corner : detection.corners) {
    const auto match =
        std::find_if(truth.begin(), truth.end(), [&](const auto& t) { return t.corner_id == corner.corner_id; });
    const double error_px = match == truth.end() ? 1e9 : (match->px - corner.px).norm();
    ++(error_px < 1.0 ? result.found : result.wrong);
    errors_px.push_back(error_px);
  }
  if (!errors_px.empty()) {
    std::nth_element(errors_px.begin(), errors_px.begin() + static_cast<std::ptrdiff_t>(errors_px.size() / 2),
                     errors_px.end());
    result.median_error_px = errors_px[errors_px.size() / 2];
  }
  return result;
}

TEST(AprilGridDetector, findsEveryCornerOfASharpBoard) {
  const target::AprilGrid grid;
  BoardScene scene(test_support::pinholeCamera(640, 480, 500.0));
  const auto truth = scene.add(grid, {1.1, 5.0 * kDegree, 1.0, 20.0 * kDegree, -25.0 * kDegree, 30.0 * kDegree});
  const Detection detection = TargetDetector(grid).detect(scene.expose(0.6, 2.0));
  const Score result = score(detection, truth);
  EXPECT_EQ(result.found, 144);
  EXPECT_EQ(result.wrong, 0);
  EXPECT_LT(result.median_error_px, 0.03);
  EXPECT_EQ(detection.counts.tags, 36);
}

}  // namespace
}  // namespace tartan_calib::detection
