#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>

#include "../../src/pipeline/bent_board.h"
#include "board_stream.h"
#include "tartan_calib/simulation/sensor.h"
#include "wide_recording.h"

/// Rounds over the images of a board that is not flat.
namespace tartan_calib::pipeline {
namespace {

using test_support::BoardScene;

constexpr std::size_t kNumBentImages = 7;
const Eigen::Vector2d kWarp_m(0.016, -0.008);  ///< of a board of 0.65 m

BoardShape shapeOf(const Eigen::Vector2d& warp_m) {
  return {calibration::BoardBend(target::cornerPoints(target::AprilGrid())), warp_m};
}

/// Where the ray of a pixel meets the flat board; empty far from it.
std::optional<Eigen::Vector2d> onBoard(const camera::Camera& camera, const geometry::Rigid3& T_cam_target,
                                       const Eigen::Vector2d& px) {
  const auto ray = camera::unproject(camera.model, px);
  if (!ray) {
    return std::nullopt;
  }
  const Eigen::Matrix3d R_target_cam = T_cam_target.rotation.toRotationMatrix().transpose();
  const Eigen::Vector3d ray_target = R_target_cam * *ray;
  const Eigen::Vector3d origin_target = -R_target_cam * T_cam_target.translation;
  const double range_m = -origin_target.z() / ray_target.z();
  const Eigen::Vector2d p_m = (origin_target + range_m * ray_target).head<2>();
  const Eigen::Vector3d far_corner_m = target::cornerPoints(target::AprilGrid()).back();
  constexpr double kSurroundings = 0.3;  // of the board, on every side: beyond its sheet
  const Eigen::Array2d share = p_m.array() / far_corner_m.head<2>().array();
  const bool is_near = (share > -kSurroundings).all() && (share < 1.0 + kSurroundings).all();
  return range_m > 0.0 && is_near ? std::optional<Eigen::Vector2d>(p_m) : std::nullopt;
}

/// What the bent board shows at every pixel, taken from the picture of the flat one.
cv::Mat1f bend(const cv::Mat1f& flat_grey, const camera::Camera& camera, const geometry::Rigid3& T_cam_target) {
  constexpr int kStep_px = 4;  // the bend is smooth
  constexpr int kIterations = 4;
  const detection::BoardMap flat = boardMap(camera, T_cam_target, shapeOf(Eigen::Vector2d::Zero()));
  const detection::BoardMap bent = boardMap(camera, T_cam_target, shapeOf(kWarp_m));
  cv::Mat2f source(flat_grey.rows / kStep_px, flat_grey.cols / kStep_px);
  for (int row = 0; row < source.rows; ++row) {
    for (int col = 0; col < source.cols; ++col) {
      const Eigen::Vector2d px = kStep_px * (Eigen::Vector2d(col, row).array() + 0.5) - 0.5;
      Eigen::Vector2d source_px = px;
      for (int i = 0; i < kIterations; ++i) {
        const auto p_m = onBoard(camera, T_cam_target, source_px);
        const auto flat_px = p_m ? flat(*p_m) : std::nullopt;
        const auto bent_px = p_m ? bent(*p_m) : std::nullopt;
        source_px = flat_px && bent_px ? Eigen::Vector2d(px + *flat_px - *bent_px) : px;
      }
      source(row, col) = cv::Vec2f(static_cast<float>(source_px.x()), static_cast<float>(source_px.y()));
    }
  }
  cv::resize(source, source, flat_grey.size());
  cv::Mat1f bent_grey;
  cv::remap(flat_grey, bent_grey, source, cv::Mat(), cv::INTER_CUBIC, cv::BORDER_REPLICATE);
  return bent_grey;
}

std::vector<StampedImage> bentImages() {
  constexpr double kPsf_px = 0.55;
  std::vector<StampedImage> images;
  for (std::size_t i = 0; i < kNumBentImages; ++i) {
    BoardScene scene(wideCamera());
    scene.add(target::AprilGrid(), widePose(i));
    simulation::applyPsf(scene.grey(), kPsf_px);
    scene.grey() = bend(scene.grey(), wideCamera(), test_support::poseOf(target::AprilGrid(), widePose(i)));
    images.push_back({kWideFirst_ns + static_cast<std::int64_t>(i) * kWidePeriod_ns,
                      [image = scene.expose(0.3, 2.0, i + 1)] { return image.clone(); }});
  }
  return images;
}

CalibrationResult runOneRound(const Listener& listener) {
  CalibrateOptions options;
  options.models = {"ds-none"};
  options.max_rounds = 1;
  options.solve.estimate_board_warp = true;
  options.recovery.search_radius_px = 1.0;  // a prediction that does not know of the bend is farther away
  return calibrate({streamOf(bentImages())}, target::AprilGrid(), options, listener);
}

/// Corners of a result, and how many of them are not where they really are.
struct Count {
  int corners = 0;
  int wrong = 0;
};

Count count(const CalibrationResult& result) {
  constexpr double kWrong_px = 0.5;
  const target::AprilGrid grid;
  const std::vector<Eigen::Vector3d> points = target::cornerPoints(grid);
  const std::vector<CameraCorners> observed = observedCorners(result);
  Count sum;
  for (const observation::CameraView& image : observed.front().images) {
    const auto index = static_cast<std::size_t>((image.stamp_ns - kWideFirst_ns) / kWidePeriod_ns);
    const detection::BoardMap truth = boardMap(wideCamera(), test_support::poseOf(grid, widePose(index)), shapeOf(kWarp_m));
    for (const observation::Corner& corner : image.corners) {
      const auto px = truth(points.at(static_cast<std::size_t>(corner.corner_id)).head<2>());
      ++sum.corners;
      sum.wrong += !px || (*px - corner.px).norm() > kWrong_px ? 1 : 0;
    }
  }
  return sum;
}

TEST(BentRoundsTest, RoundsLookForCornersOnTheBentBoard) {
  Count before;
  Listener listener;
  listener.detection_solved = [&before](const CalibrationResult& detected) { before = count(detected); };
  const CalibrationResult after = runOneRound(listener);
  EXPECT_LT((after.solution.board_warp_m - kWarp_m).norm(), 0.01 * kWarp_m.norm());
  EXPECT_GT(count(after).corners, before.corners + 10);
  EXPECT_EQ(count(after).wrong, 0);
}

}  // namespace
}  // namespace tartan_calib::pipeline
