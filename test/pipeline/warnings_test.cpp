#include "tartan_calib/pipeline/warnings.h"

#include <gtest/gtest.h>

namespace tartan_calib::pipeline {
namespace {

camera::Camera cameraOf(const std::string& model, const std::vector<double>& parameters) {
  const Eigen::Map<const Eigen::VectorXd> values(parameters.data(), static_cast<Eigen::Index>(parameters.size()));
  return {camera::withParameters(camera::modelByName(model), values), 640, 480};
}

/// One camera with much good data all over the image: nothing to warn about.
CalibrationResult goodResult(const camera::Camera& camera = cameraOf("pinhole-none", {400, 400, 319.5, 239.5})) {
  CalibrationResult result;
  result.solution.status = calibration::SolveStatus::kConverged;
  result.solution.rig.cameras = {{camera, geometry::Rigid3()}};
  calibration::CornerCounts counts;
  counts.used = 10000;
  result.solution.counts = {counts};
  CameraReport report;
  report.statistics.num_views = 100;
  report.statistics.num_corners = 10000;
  report.statistics.rms_px = 0.2;
  result.cameras = {report};
  observation::View view;
  view.cameras = {{0, 0, {}}};
  for (int u = 5; u < 640; u += 20) {
    for (int v = 5; v < 480; v += 20) {
      observation::Corner corner;
      corner.px = {u, v};
      view.cameras[0].corners.push_back(corner);
    }
  }
  result.solution.views = {view};
  return result;
}

void expectOneWarning(const CalibrationResult& result, const std::string& part) {
  const std::vector<std::string> warnings = resultWarnings(result);
  ASSERT_EQ(warnings.size(), 1U) << part;
  EXPECT_NE(warnings[0].find(part), std::string::npos) << warnings[0];
}

TEST(ResultWarnings, AGoodCalibrationHasNone) { EXPECT_TRUE(resultWarnings(goodResult()).empty()); }

TEST(ResultWarnings, FewViewsOrCornersAreUncertain) {
  CalibrationResult result = goodResult();
  result.cameras[0].statistics.num_views = 2;
  expectOneWarning(result, "only 2 views with 10000 corners");
  result = goodResult();
  result.cameras[0].statistics.num_corners = 120;
  expectOneWarning(result, "only 100 views with 120 corners");
}

TEST(ResultWarnings, CornersInAPartOfTheImageAreTold) {
  CalibrationResult result = goodResult();
  for (observation::Corner& corner : result.solution.views[0].cameras[0].corners) {
    corner.used = corner.px.x() < 320.0 && corner.px.y() < 240.0;
  }
  expectOneWarning(result, "cam0: corners cover only 25 % of the image");
}

TEST(ResultWarnings, ResidualsAndRejectedCornersAreTold) {
  CalibrationResult result = goodResult();
  result.cameras[0].statistics.rms_px = 1.5;
  expectOneWarning(result, "rms 1.50 px");
  result = goodResult();
  result.solution.counts[0].outliers = 600;
  result.solution.counts[0].unprojectable = 50;
  result.solution.counts[0].unsupported = 30;
  expectOneWarning(result, "680 of 10680 corners were rejected (600 outliers, 50 that");
}

TEST(ResultWarnings, APrincipalPointFarOffIsTold) {
  expectOneWarning(goodResult(cameraOf("pinhole-none", {400, 400, 430, 239.5})), "principal point (430.0, 239.5) is far");
  EXPECT_TRUE(resultWarnings(goodResult(cameraOf("pinhole-none", {400, 400, 390, 200}))).empty());
}

TEST(ResultWarnings, WhatKalibrWouldNotWriteIsTold) {
  const std::vector<std::string> warnings = resultWarnings(goodResult(cameraOf("pinhole-none", {400, 400, -5, 239.5})));
  ASSERT_EQ(warnings.size(), 2U);
  EXPECT_EQ(warnings[1], "cam0: the principal point is outside of what Kalibr accepts in a camchain");
  expectOneWarning(goodResult(cameraOf("omni-none", {-0.1, 400, 400, 319.5, 239.5})), "xi is outside");
  expectOneWarning(goodResult(cameraOf("eucm-none", {1.0, 1.0, 400, 400, 319.5, 239.5})), "alpha is outside");
  expectOneWarning(goodResult(cameraOf("eucm-none", {0.5, -1.0, 400, 400, 319.5, 239.5})), "beta is outside");
  expectOneWarning(goodResult(cameraOf("ds-none", {-0.2, 1.0, 400, 400, 319.5, 239.5})), "alpha is outside");
  EXPECT_TRUE(resultWarnings(goodResult(cameraOf("ds-none", {-0.2, 0.5, 400, 400, 319.5, 239.5}))).empty());
}

TEST(ResultWarnings, CornersBeyondTheHemisphereAreToldForPinholesOnly) {
  CalibrationResult result = goodResult(cameraOf("pinhole-equi", {200, 200, 319.5, 239.5, 0, 0, 0, 0}));
  result.cameras[0].statistics.max_polar_angle_rad = 1.58;
  expectOneWarning(result, "corners to 90.5 degrees from the axis were used; pinhole-equi");
  result = goodResult(cameraOf("ds-none", {-0.2, 0.5, 400, 400, 319.5, 239.5}));
  result.cameras[0].statistics.max_polar_angle_rad = 1.7;
  EXPECT_TRUE(resultWarnings(result).empty());
}

TEST(ResultWarnings, ViewsParametersAndConvergenceAreTold) {
  CalibrationResult result = goodResult();
  result.num_dropped_views = 3;
  expectOneWarning(result, "3 views were left out");
  result = goodResult();
  result.solution.undetermined = {"cam0: fu", "cam0: fv"};
  expectOneWarning(result, "do not determine cam0: fu, cam0: fv");
  result = goodResult();
  result.solution.status = calibration::SolveStatus::kMaxIterations;
  result.solution.iterations = 100;
  expectOneWarning(result, "did not converge within 100 iterations");
}

TEST(DetectionWarnings, NothingUnusualIsNoWarning) {
  CameraCorners corners;
  corners.counts.tags = 100;
  EXPECT_TRUE(detectionWarnings(corners, 0, target::AprilGrid()).empty());
}

TEST(DetectionWarnings, EveryKindOfSkippedImageAndTagIsTold) {
  CameraCorners corners;
  corners.width = 640;
  corners.height = 480;
  corners.num_other_size = 2;
  corners.num_unreadable = 3;
  corners.unreadable_reason = "truncated JPEG";
  corners.num_same_stamp = 4;
  corners.counts.tags = 100;
  corners.counts.duplicate_tags = 5;
  corners.counts.foreign_tags = 6;
  corners.counts.mirrored_tags = 7;
  const std::vector<std::string> warnings = detectionWarnings(corners, 1, target::AprilGrid());
  const std::vector<std::string> expected = {"2 images are not 640x480",
                                             "3 images cannot be read",
                                             "4 images have the stamp",
                                             "5 tags were dropped because their id",
                                             "6 tags were dropped that the target",
                                             "7 tags were dropped because they are mirrored"};
  ASSERT_EQ(warnings.size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    EXPECT_EQ(warnings[i].rfind("cam1: " + expected[i], 0), 0U) << warnings[i];
  }
  EXPECT_NE(warnings[1].find("truncated JPEG"), std::string::npos);
}

TEST(DetectionWarnings, ABoardOfAnotherSizeIsNamedWhereClearlyMoreImagesShowIt) {
  CameraCorners corners;
  corners.counts.other_sizes = {{{8, 10}, 3}, {{8, 11}, 20}};
  corners.images.resize(5);
  const target::Target board = target::Checkerboard{10, 7, 0.02, 0.02};
  EXPECT_EQ(detectionWarnings(corners, 0, board),
            std::vector<std::string>{
                "cam0: 20 images show 8x11 inner corners, the target says 7x10: set targetCols and targetRows"});
  corners.images.resize(20);
  EXPECT_TRUE(detectionWarnings(corners, 0, board).empty());
  corners.images.resize(5);
  corners.counts.other_sizes[{8, 10}] = 20;
  EXPECT_TRUE(detectionWarnings(corners, 0, board).empty());
  corners.counts.other_sizes = {{{6, 5}, 20}};
  const std::vector<std::string> warnings = detectionWarnings(corners, 0, target::AprilGrid());
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_EQ(warnings[0],
            "cam0: 20 images show 6 rows and 5 columns of tags, the target says 6 and 6: set tagRows and tagCols");
}

TEST(BoardNote, IsWhatMostTagsWereDroppedFor) {
  CameraCorners corners;
  EXPECT_EQ(boardNote(corners, target::AprilGrid()), std::nullopt);
  corners.counts.tags = 40;
  corners.counts.mirrored_tags = 40;
  corners.counts.duplicate_tags = 12;
  EXPECT_EQ(boardNote(corners, target::AprilGrid()), std::nullopt);
  corners.counts.mirrored_tags = 41;
  EXPECT_EQ(boardNote(corners, target::AprilGrid()).value_or("").rfind("41 tags were dropped because they are mirrored", 0),
            0U);
  corners.counts.other_border_tags = 100;
  EXPECT_EQ(boardNote(corners, target::AprilGrid()).value_or("").rfind("the tags have a border of 1 cells", 0), 0U);
}

TEST(DetectionWarnings, AnotherBorderWidthIsAHintWithTheRemedy) {
  CameraCorners corners;
  corners.counts.tags = 1;
  corners.counts.other_border_tags = 200;
  target::AprilGrid grid;
  std::vector<std::string> warnings = detectionWarnings(corners, 0, grid);
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_NE(warnings[0].find("border of 1 cells, the target says 2: set tagBorder: 1"), std::string::npos) << warnings[0];
  grid.border_cells = 1;
  warnings = detectionWarnings(corners, 0, grid);
  EXPECT_NE(warnings[0].find("set tagBorder: 2"), std::string::npos) << warnings[0];
  corners.counts.tags = 300;
  EXPECT_TRUE(detectionWarnings(corners, 0, grid).empty());
}

}  // namespace
}  // namespace tartan_calib::pipeline
