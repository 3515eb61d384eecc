#include "tartan_calib/pipeline/virtual_view.h"

#include <gtest/gtest.h>

#include <cmath>

#include "wide_recording.h"

namespace tartan_calib::pipeline {
namespace {

using test_support::kDegree;

Eigen::Vector3d centreRay(const VirtualPinhole& pinhole) { return pinhole.R_cam_view.col(2); }

/// Pixels of a coarse grid over the image that the lens gives a ray.
std::vector<Eigen::Vector2d> imagePixels(const camera::Camera& camera) {
  constexpr double kStep_px = 13.0;
  std::vector<Eigen::Vector2d> pixels;
  for (double v = 0.0; v < camera.height; v += kStep_px) {
    for (double u = 0.0; u < camera.width; u += kStep_px) {
      if (camera::unproject(camera.model, {u, v})) {
        pixels.emplace_back(u, v);
      }
    }
  }
  return pixels;
}

bool isInView(const Eigen::Vector2d& px, const VirtualPinhole& pinhole) {
  return px.x() >= 0.0 && px.y() >= 0.0 && px.x() <= pinhole.width - 1 && px.y() <= pinhole.height - 1;
}

TEST(PinholeView, LooksUpByDefaultAndAheadWithoutAPose) {
  EXPECT_TRUE(centreRay(pinholeView({}, 90.0 * kDegree, 0.0)).isApprox(-Eigen::Vector3d::UnitY(), 1e-12));
  EXPECT_TRUE(centreRay(pinholeView({}, 0.0, 0.0)).isApprox(Eigen::Vector3d::UnitZ(), 1e-12));
  EXPECT_TRUE(centreRay(pinholeView({}, 90.0 * kDegree, 90.0 * kDegree)).isApprox(Eigen::Vector3d::UnitX(), 1e-12));
}

TEST(PinholeView, ReachesItsAnglesInTheOutermostPixels) {
  const ViewSize size{80.0 * kDegree, 40.0 * kDegree, 300, 200};
  const VirtualPinhole pinhole = pinholeView(size, 0.0, 0.0);
  const Eigen::Vector2d corner = (Eigen::Vector2d(299.0, 199.0) - pinhole.centre_px).cwiseQuotient(pinhole.focal_px);
  EXPECT_NEAR(std::atan(corner.x()), 40.0 * kDegree, 1e-12);
  EXPECT_NEAR(std::atan(corner.y()), 20.0 * kDegree, 1e-12);
}

TEST(CubeViews, ShowEveryPixelOfAWideLens) {
  const auto pinholes = cubeViews({90.0 * kDegree, 90.0 * kDegree, 200, 200});
  std::vector<VirtualView> views;
  for (const VirtualPinhole& pinhole : pinholes) {
    views.emplace_back(wideCamera(), pinhole);
  }
  for (const Eigen::Vector2d& px : imagePixels(wideCamera())) {
    int num_views = 0;
    for (std::size_t i = 0; i < views.size(); ++i) {
      const auto view_px = views[i].toView(px);
      num_views += view_px && isInView(*view_px, pinholes[i]) ? 1 : 0;
    }
    EXPECT_GE(num_views, 1) << px.transpose();
  }
}

TEST(VirtualView, TakesAPixelThereAndBackThroughEveryModel) {
  constexpr double kMaxError_px = 1e-3;
  for (const std::string& name : camera::modelNames()) {
    const camera::Camera camera{camera::startModel(camera::modelByName(name), 300.0, {319.5, 239.5}), 640, 480};
    int num_pixels = 0;
    for (const VirtualPinhole& pinhole : cubeViews({90.0 * kDegree, 90.0 * kDegree, 200, 200})) {
      const VirtualView view(camera, pinhole);
      for (const Eigen::Vector2d& px : imagePixels(camera)) {
        const auto view_px = view.toView(px);
        if (!view_px || !isInView(*view_px, pinhole)) {
          continue;
        }
        const auto back = view.toImage(*view_px);
        ASSERT_TRUE(back) << name << " " << px.transpose();
        EXPECT_LT((*back - px).norm(), kMaxError_px) << name << " " << px.transpose();
        ++num_pixels;
      }
    }
    EXPECT_GT(num_pixels, 1000) << name;
  }
}

TEST(VirtualView, ShowsTheGreyValuesOfThePixelsItStandsFor) {
  const camera::Camera camera = wideCamera();
  cv::Mat ramp(camera.height, camera.width, CV_8UC1);
  for (int row = 0; row < ramp.rows; ++row) {
    for (int col = 0; col < ramp.cols; ++col) {
      ramp.at<std::uint8_t>(row, col) = cv::saturate_cast<std::uint8_t>(0.2 * col + 0.15 * row);
    }
  }
  const VirtualPinhole pinhole = pinholeView({90.0 * kDegree, 90.0 * kDegree, 400, 400}, 90.0 * kDegree, 0.7);
  const VirtualView view(camera, pinhole);
  const cv::Mat seen = view.remap(ramp);
  int num_pixels = 0;
  for (int row = 0; row < seen.rows; row += 7) {
    for (int col = 0; col < seen.cols; col += 7) {
      const auto px = view.toImage(Eigen::Vector2d(col, row));
      if (px && px->minCoeff() > 1.0 && px->maxCoeff() < camera.width - 2.0) {
        EXPECT_NEAR(seen.at<std::uint8_t>(row, col), 0.2 * px->x() + 0.15 * px->y(), 1.1);  // rounded twice
        ++num_pixels;
      }
    }
  }
  EXPECT_GT(num_pixels, 500);
}

TEST(VirtualView, IsBlackWhereTheLensSeesNothing) {
  const cv::Mat white(640, 640, CV_8UC1, cv::Scalar(255));
  const VirtualPinhole behind = pinholeView({}, 180.0 * kDegree, 0.0);
  EXPECT_EQ(cv::countNonZero(VirtualView(wideCamera(), behind).remap(white)), 0);
}

TEST(RectifiedView, ShowsTheBoardUprightInItsMiddle) {
  constexpr int kSize_px = 500;
  const std::vector<Eigen::Vector3d> points = target::cornerPoints(target::AprilGrid());
  const geometry::Rigid3 T_cam_target = test_support::poseOf(target::AprilGrid(), widePose(12));
  const auto pinhole = rectifiedView(T_cam_target, points, kSize_px, kSize_px);
  ASSERT_TRUE(pinhole);
  const VirtualView view(wideCamera(), *pinhole);
  const auto shown = [&](const Eigen::Vector3d& point) {
    return view.toView(*camera::project(wideCamera().model, T_cam_target * point)).value();
  };
  const double low = 0.2 * kSize_px - 0.5;
  const double high = 0.8 * kSize_px - 0.5;
  EXPECT_LT((shown(points.front()) - Eigen::Vector2d(low, high)).norm(), 1e-3);
  EXPECT_LT((shown(points.back()) - Eigen::Vector2d(high, low)).norm(), 1e-3);
}

TEST(RectifiedView, IsNoneOfABoardSeenFromBehind) {
  geometry::Rigid3 T_cam_target = test_support::poseOf(target::AprilGrid(), widePose(0));
  T_cam_target.translation *= -1.0;
  EXPECT_FALSE(rectifiedView(T_cam_target, target::cornerPoints(target::AprilGrid()), 500, 500));
}

}  // namespace
}  // namespace tartan_calib::pipeline
