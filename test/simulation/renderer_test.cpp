#include "tartan_calib/simulation/renderer.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <map>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <stdexcept>
#include <utility>
#include <vector>

#include "tartan_calib/error.h"
#include "tartan_calib/simulation/board_pattern.h"
#include "tartan_calib/simulation/lens.h"
#include "tartan_calib/simulation/recording.h"

namespace tartan_calib::simulation {
namespace {

SceneCamera smallFisheye() {
  LensRequest request;
  request.width = 320;
  request.height = 256;
  return makeLens(request);
}

/// Two cameras, a few views with everything that a recording can have.
Scene smallScene(std::uint64_t seed) {
  RecordingOptions options;
  options.target = target::AprilGrid{3, 4, 0.08, 0.3, "t36h11", 0, 2};
  options.cameras = makeRig({smallFisheye(), anotherPiece(smallFisheye(), 7)}, 0.1, 0.2, seed);
  options.num_frames = 6;
  options.blurred_ratio = 0.5;
  options.max_blur_px = 3.0;
  options.hand_ratio = 0.5;
  options.seed = seed;
  return makeRecording(options);
}

/// One camera and one view of a board straight ahead, without noise; tests change what they need.
Scene stillScene() {
  Scene scene;
  scene.target = target::AprilGrid{3, 4, 0.08, 0.3, "t36h11", 0, 2};
  scene.cameras = {smallFisheye()};
  scene.sensor = {0.0, 0.0, 0.0};
  SceneFrame frame;
  const Eigen::Quaterniond facing(Eigen::AngleAxisd(M_PI, Eigen::Vector3d::UnitX()));
  frame.T_rig_target = geometry::Rigid3(geometry::expRotation({0.2, 0.3, 0.1}) * facing, {-0.2, 0.12, 0.25});
  scene.frames = {frame};
  return scene;
}

/// Everything about a recording in one number for each picture and corner.
std::vector<double> fingerprint(const Renderer& renderer, int num_threads) {
  std::vector<double> print;
  renderAll(renderer, num_threads, [&print](const RenderedFrame& frame) {
    print.push_back(static_cast<double>(frame.stamp_ns));
    for (const RenderedView& view : frame.views) {
      cv::Mat1d weights(view.image.size());
      cv::RNG(1).fill(weights, cv::RNG::UNIFORM, 0.0, 1.0);
      cv::Mat grey;
      view.image.convertTo(grey, CV_64F);
      print.push_back(grey.dot(weights));
      for (const TrueCorner& corner : view.corners) {
        print.insert(print.end(), {corner.px.x(), corner.visible ? 1.0 : 0.0, corner.bound_px2(0, 1)});
      }
    }
  });
  return print;
}

TEST(Renderer, givesTheSameBytesForEveryNumberOfThreads) {
  const Renderer renderer(smallScene(3));
  const std::vector<double> one_thread = fingerprint(renderer, 1);
  EXPECT_EQ(one_thread, fingerprint(renderer, 2));
  EXPECT_EQ(one_thread, fingerprint(Renderer(smallScene(3)), 5));
  EXPECT_NE(one_thread, fingerprint(Renderer(smallScene(4)), 1));
}

TEST(Renderer, handsFramesOverInOrderAndPassesOnWhatTheReceiverThrows) {
  const Renderer renderer(smallScene(3));
  std::vector<std::int64_t> stamps;
  renderAll(renderer, 3, [&stamps](const RenderedFrame& frame) { stamps.push_back(frame.stamp_ns); });
  EXPECT_EQ(stamps.size(), 6U);
  EXPECT_TRUE(std::is_sorted(stamps.begin(), stamps.end()));
  EXPECT_THROW(renderAll(renderer, 3, [](const RenderedFrame& /*frame*/) { throw std::runtime_error("disk full"); }),
               std::runtime_error);
}

TEST(Renderer, beginsNoFurtherViewOnceStopped) {
  const Renderer renderer(smallScene(3));
  const std::atomic<bool> is_stopped = true;
  EXPECT_TRUE(renderer.render(0, is_stopped).views.empty());
  const auto receive = [](const RenderedFrame& /*frame*/) { FAIL() << "the wait for the first frame threw"; };
  EXPECT_THROW(renderAll(renderer, 1, receive, [] { throw std::runtime_error("stopped"); }), std::runtime_error);
}

TEST(Renderer, projectsCornersThroughEachCameraOfTheRig) {
  const Renderer renderer(smallScene(3));
  const Scene& scene = renderer.scene();
  const std::vector<Eigen::Vector3d> points = target::cornerPoints(scene.target);
  int count = 0;
  for (int i = 0; i < 2; ++i) {
    const RenderedFrame frame = renderer.render(i);
    ASSERT_EQ(frame.views.size(), 2U);
    for (std::size_t k = 0; k < 2; ++k) {
      for (const TrueCorner& corner : frame.views[k].corners) {
        const Eigen::Vector3d p_rig =
            scene.frames[static_cast<std::size_t>(i)].T_rig_target * points[static_cast<std::size_t>(corner.corner_id)];
        const auto px = camera::project(scene.cameras[k].camera.model, scene.cameras[k].T_cam_rig * p_rig);
        EXPECT_LT((corner.px - *px).norm(), 1e-9);
        ++count;
      }
    }
  }
  EXPECT_GT(count, 100);
}

TEST(Renderer, blursMotionIntoTheMeanOfItsMoments) {
  Scene scene = stillScene();
  SceneFrame moving = scene.frames[0];
  moving.motion << 0.03, -0.02, 0.01, 0.02, 0.0, 0.05;
  moving.hand = Hand{{0.1, 0.1}, 1.0, 0.5};
  constexpr int kMoments = 101;
  scene.frames = {moving};
  for (int i = 0; i < kMoments; ++i) {
    SceneFrame moment = moving;
    moment.motion.setZero();
    moment.T_rig_target = moving.T_rig_target * geometry::expRigid(((i + 0.5) / kMoments - 0.5) * moving.motion);
    scene.frames.push_back(moment);
  }
  const Renderer renderer(scene);
  cv::Mat mean = cv::Mat::zeros(256, 320, CV_32F);
  for (int i = 1; i <= kMoments; ++i) {
    mean += renderer.renderLight(i, 0) / kMoments;
  }
  const cv::Mat blurred = renderer.renderLight(0, 0);
  const cv::Mat sharp = renderer.renderLight(1 + kMoments / 2, 0);
  EXPECT_GT(cv::norm(sharp, mean, cv::NORM_INF), 60.0) << "the motion must matter";
  // Half a pixel between moments: an edge of 180 grey levels is summed in steps of at most a tenth.
  EXPECT_LT(cv::norm(blurred, mean, cv::NORM_INF), 8.0);
  EXPECT_LT(cv::norm(blurred, mean, cv::NORM_L2) / std::sqrt(320.0 * 256.0), 0.5);
}

/// Distance to the nearest pixel that is not zero.
double distanceToNonZero(const cv::Mat& image, const Eigen::Vector2d& px) {
  double nearest_px = 1e9;
  for (int row = 0; row < image.rows; ++row) {
    for (int col = 0; col < image.cols; ++col) {
      if (image.at<float>(row, col) > 1e-2F) {
        nearest_px = std::min(nearest_px, (px - Eigen::Vector2d(col, row)).norm());
      }
    }
  }
  return nearest_px;
}

TEST(Renderer, saysWhichCornersAHandHides) {
  constexpr int kHands = 8;  // so many that corners lie at every distance from one
  Scene scene = stillScene();
  for (int i = 0; i < kHands; ++i) {
    scene.frames.push_back(scene.frames[0]);
    scene.frames.back().hand = Hand{{0.05 + 0.05 * i, 0.12}, 2.0, 0.6};
  }
  const Renderer renderer(scene);
  const cv::Mat without = renderer.renderLight(0, 0);
  int num_hidden = 0;
  int num_visible = 0;
  for (int i = 1; i <= kHands; ++i) {
    const cv::Mat changed = cv::abs(without - renderer.renderLight(i, 0));
    const auto frame = renderer.render(i);
    for (const TrueCorner& corner : frame.views[0].corners) {
      const double nearest_px = distanceToNonZero(changed, corner.px);
      EXPECT_TRUE(!corner.visible || nearest_px > kMinOccluderDistancePx - 0.5) << corner.corner_id;
      EXPECT_TRUE(corner.visible || nearest_px < kMinOccluderDistancePx + 1.5) << corner.corner_id;
      (corner.visible ? num_visible : num_hidden) += 1;
    }
  }
  EXPECT_GE(num_hidden, 5 * kHands);
  EXPECT_GE(num_visible, 20 * kHands);
  const auto without_hand = renderer.render(0);
  for (const TrueCorner& corner : without_hand.views[0].corners) {
    EXPECT_TRUE(corner.visible);
  }
}

TEST(Renderer, CallsACornerHiddenWhereTheHandCoversItAndNotWhereItIsOnlyNear) {
  Scene scene = stillScene();
  SceneFrame& frame = scene.frames[0];
  frame.motion.setZero();
  const cv::Mat without = Renderer(scene).renderLight(0, 0);
  frame.hand = Hand{{0.15, 0.12}, 2.0, 0.6};
  const Renderer renderer(scene);
  const cv::Mat changed = cv::abs(without - renderer.renderLight(0, 0));
  cv::Mat unchanged;
  cv::Mat(changed < 1e-2).convertTo(unchanged, CV_32F);
  const auto rendered = renderer.render(0);
  int num_hidden = 0;
  int num_near = 0;
  for (const TrueCorner& corner : rendered.views[0].corners) {
    const double hand_px = distanceToNonZero(changed, corner.px);
    EXPECT_FALSE(corner.visible && corner.hidden);
    EXPECT_TRUE(!corner.hidden || hand_px < 1.0) << corner.corner_id;
    const bool is_near = !corner.visible && !corner.hidden;
    EXPECT_TRUE(!is_near || hand_px < kMinOccluderDistancePx + 1.5) << corner.corner_id;
    EXPECT_TRUE(!is_near || distanceToNonZero(unchanged, corner.px) < 1.0) << corner.corner_id;
    num_hidden += corner.hidden ? 1 : 0;
    num_near += is_near ? 1 : 0;
  }
  EXPECT_GE(num_hidden, 3);
  EXPECT_GE(num_near, 1);
}

TEST(Renderer, ShowsAHandThatOnlyEntersTheImageAfterTheMiddleOfTheExposure) {
  Scene scene = stillScene();
  LensRequest narrow;
  narrow.lens = "pinhole60";
  narrow.width = 160;
  narrow.height = 128;
  scene.cameras = {makeLens(narrow)};
  SceneFrame& frame = scene.frames[0];
  const Eigen::Quaterniond facing(Eigen::AngleAxisd(M_PI, Eigen::Vector3d::UnitX()));
  frame.T_rig_target = geometry::Rigid3(facing, {-0.2, 0.12, 0.5});
  frame.motion << 0.1, 0.0, 0.0, 0.0, 0.0, 0.0;
  const cv::Mat1f without = Renderer(scene).renderLight(0, 0);
  const double left_edge_m = 0.2 - 0.5 * std::tan(M_PI / 6.0);
  constexpr double kFingertip_m = 0.134;  // before the palm
  frame.hand = Hand{{left_edge_m - kFingertip_m - 0.02, 0.12}, 0.0, 1.0};
  const Renderer renderer(scene);
  EXPECT_GT(cv::norm(without, renderer.renderLight(0, 0), cv::NORM_INF), 1.0);
  const auto rendered = renderer.render(0);
  for (const TrueCorner& corner : rendered.views[0].corners) {
    EXPECT_FALSE(corner.hidden) << corner.corner_id;
  }
}

TEST(Renderer, saysHowFarCornersMoveDuringTheExposure) {
  Scene scene = stillScene();
  SceneFrame& frame = scene.frames[0];
  frame.motion << 0.02, -0.01, 0.015, 0.03, -0.02, 0.05;
  const auto moving = Renderer(scene).render(0).views[0].corners;
  const auto corners_at = [&](double s) {
    return projectCorners(scene.target, scene.cameras[0].camera,
                          scene.cameras[0].T_cam_rig * frame.T_rig_target * geometry::expRigid(s * frame.motion));
  };
  std::map<int, Eigen::Vector2d> start_px;
  for (const TrueCorner& corner : corners_at(-0.5)) {
    start_px[corner.corner_id] = corner.px;
  }
  std::map<int, double> way_px;
  for (const TrueCorner& corner : corners_at(0.5)) {
    if (start_px.count(corner.corner_id) > 0) {
      way_px[corner.corner_id] = (corner.px - start_px[corner.corner_id]).norm();
    }
  }
  int num_compared = 0;
  for (const TrueCorner& corner : moving) {
    if (way_px.count(corner.corner_id) > 0) {
      EXPECT_NEAR(corner.motion_px, way_px[corner.corner_id], 1e-9);
      num_compared += corner.motion_px > 1.0 ? 1 : 0;
    }
  }
  EXPECT_GE(num_compared, 20);
  frame.motion.setZero();
  const auto still = Renderer(scene).render(0).views[0].corners;
  for (const TrueCorner& corner : still) {
    EXPECT_EQ(corner.motion_px, 0.0);
  }
}

TEST(Renderer, isBlackOutsideOfTheLensCircleAndSaysSoOfItsCorners) {
  Scene scene = stillScene();
  scene.cameras[0].image_circle_px = 60.0;
  scene.cameras[0].vignetting = 0.0;
  const Renderer renderer(scene);
  const RenderedView view = renderer.render(0).views[0];
  const Eigen::Vector2d centre(159.5, 127.5);
  int num_outside = 0;
  for (const TrueCorner& corner : view.corners) {
    const double r = (corner.px - centre).norm();
    EXPECT_EQ(corner.visible, r <= 58.0) << r;
    EXPECT_EQ(corner.hidden, r > 60.0) << r;
    num_outside += corner.visible ? 0 : 1;
  }
  EXPECT_GT(num_outside, 5);
  for (const auto& [inside, outside] : {std::pair{101, 98}, std::pair{218, 221}}) {
    EXPECT_GT(view.image.at<unsigned char>(127, inside), 10);
    EXPECT_EQ(view.image.at<unsigned char>(127, outside), 0);
  }
}

TEST(Renderer, takesLightAwayTowardsTheRim) {
  Scene scene = stillScene();
  scene.cameras[0].vignetting = 0.0;
  const cv::Mat plain = Renderer(scene).renderLight(0, 0);
  scene.cameras[0].vignetting = 0.6;
  const cv::Mat shaded = Renderer(scene).renderLight(0, 0);
  const auto ratio = [&](int col) {
    return static_cast<double>(shaded.at<float>(127, col)) / static_cast<double>(plain.at<float>(127, col));
  };
  const double circle_px = scene.cameras[0].image_circle_px;
  EXPECT_NEAR(ratio(160), 1.0, 1e-3);
  EXPECT_NEAR(ratio(static_cast<int>(159.5 + circle_px)), 0.4, 0.05) << "at the rim";
  EXPECT_GT(ratio(200), ratio(240));
  EXPECT_GT(ratio(240), ratio(300));
}

TEST(Renderer, collectsLightInProportionToTheExposure) {
  Scene scene = stillScene();
  scene.frames.push_back(scene.frames[0]);
  scene.frames[1].exposure_ratio = 1.7;
  const Renderer renderer(scene);
  const cv::Mat expected = 1.7 * renderer.renderLight(0, 0);
  EXPECT_LT(cv::norm(renderer.renderLight(1, 0), expected, cv::NORM_INF), 1e-3);
  scene.sensor.read_noise_grey = 2.0;
  scene.frames[1].exposure_ratio = 40.0;
  int num_unknown = 0;
  const auto frame = Renderer(scene).render(1);
  for (const TrueCorner& corner : frame.views[0].corners) {
    num_unknown += corner.bound_px2(0, 0) > 1e3 ? 1 : 0;
  }
  EXPECT_GT(num_unknown, 10) << "everything saturated around these corners tells nothing of them";
}

TEST(Renderer, boundsCornersByTheInformationInTheirPixels) {
  // Fronto-parallel through a pinhole: the window around a corner is a square in the image.
  constexpr double kFocalPx = 400.0;
  constexpr double kDistanceM = 0.8;
  constexpr double kShiftPx = 0.02;
  Scene scene = stillScene();
  scene.sensor = {0.7, 1.5, 0.03};
  const auto camera_at = [&](double cu, double cv) {
    SceneCamera lens;
    lens.camera = {camera::PinholeNone(Eigen::Vector4d(kFocalPx, kFocalPx, cu, cv)), 320, 256};
    lens.vignetting = 0.0;
    return lens;
  };
  const Eigen::Quaterniond facing(Eigen::AngleAxisd(M_PI, Eigen::Vector3d::UnitX()));
  scene.frames[0].T_rig_target = geometry::Rigid3(facing, {-0.2006, 0.1207, kDistanceM});
  const auto light = [&](double du, double dv) {
    scene.cameras = {camera_at(160.0 + du, 128.0 + dv)};
    return Renderer(scene).renderLight(0, 0);
  };
  const cv::Mat1f here = light(0.0, 0.0);
  const cv::Mat by_u = (light(kShiftPx, 0.0) - light(-kShiftPx, 0.0)) / (2.0 * kShiftPx);
  const cv::Mat by_v = (light(0.0, kShiftPx) - light(0.0, -kShiftPx)) / (2.0 * kShiftPx);
  scene.cameras = {camera_at(160.0, 128.0)};
  const RenderedView view = Renderer(scene).render(0).views[0];
  const double half_window_px = cornerHalfWindow(scene.target) * kFocalPx / kDistanceM;
  ASSERT_EQ(view.corners.size(), 48U);
  for (const TrueCorner& corner : view.corners) {
    Eigen::Matrix2d information = Eigen::Matrix2d::Zero();
    for (int row = 0; row < here.rows; ++row) {
      for (int col = 0; col < here.cols; ++col) {
        if ((Eigen::Vector2d(col, row) - corner.px).cwiseAbs().maxCoeff() <= half_window_px) {
          const Eigen::Vector2d J(static_cast<double>(by_u.at<float>(row, col)),
                                  static_cast<double>(by_v.at<float>(row, col)));
          information += J * J.transpose() / (2.25 + 0.03 * static_cast<double>(here(row, col)) + 1.0 / 12.0);
        }
      }
    }
    const Eigen::Matrix2d expected = information.inverse();
    // The numeric derivative also sees the sheen move, which the corner's does not.
    EXPECT_LT((corner.bound_px2 - expected).norm(), 0.03 * expected.norm()) << corner.corner_id;
  }
}

TEST(Renderer, refusesCircleGrids) {
  Scene scene = stillScene();
  scene.target = target::CircleGrid{4, 5, 0.05, false};
  EXPECT_THROW(Renderer{scene}, InputError);
}

}  // namespace
}  // namespace tartan_calib::simulation
