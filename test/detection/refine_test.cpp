#include "tartan_calib/detection/refine.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>
#include <functional>
#include <limits>
#include <opencv2/imgproc.hpp>

#include "support/board_scene.h"
#include "tartan_calib/camera/camera.h"

namespace tartan_calib::detection {
namespace {

using simulation::TrueCorner;
using test_support::BoardPose;
using test_support::BoardScene;
using test_support::kDegree;

const target::AprilGrid kGrid;
constexpr double kHalfWindow_m = 0.15 * 0.088;

/// A board in a picture with the exact map from the board to pixels.
struct Scene {
  Scene(const camera::Camera& camera_in, const BoardPose& pose)
      : camera(camera_in),
        T_cam_target(test_support::poseOf(kGrid, pose)),
        picture(camera_in),
        corners(picture.add(kGrid, pose)) {}

  BoardToPixelOffset mapAround(int corner_id) const {
    const Eigen::Vector3d corner = target::cornerPoints(kGrid).at(static_cast<std::size_t>(corner_id));
    const Eigen::Vector2d corner_px = *camera::project(camera.model, T_cam_target * corner);
    return [this, corner, corner_px](const Eigen::Vector2d& offset) {
      const Eigen::Vector3d point = corner + Eigen::Vector3d(offset.x(), offset.y(), 0.0);
      return Eigen::Vector2d(*camera::project(camera.model, T_cam_target * point) - corner_px);
    };
  }

  camera::Camera camera;
  geometry::Rigid3 T_cam_target;
  BoardScene picture;
  std::vector<TrueCorner> corners;
};

Scene plain() {
  return {test_support::pinholeCamera(640, 480, 500.0), {1.1, 3.0 * kDegree, 1.0, 20.0 * kDegree, -25.0 * kDegree, 0.5}};
}

RefineOptions options() {
  RefineOptions result;
  result.half_window = kHalfWindow_m;
  return result;
}

/// Error of every corner that is refined from `start_offset_px` beside the truth.
std::vector<double> errors(const Scene& scene, const cv::Mat& image, const Eigen::Vector2d& start_offset_px) {
  std::vector<double> result;
  for (const TrueCorner& corner : scene.corners) {
    const auto refined = refineBySymmetry(image, corner.px + start_offset_px, scene.mapAround(corner.corner_id), options());
    if (refined) {
      result.push_back((refined->px - corner.px).norm());
    }
  }
  return result;
}

double rms(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) {
    sum += value * value;
  }
  return std::sqrt(sum / static_cast<double>(values.size()));
}

TEST(RefineBySymmetry, recoversCornersFromStartsAllAround) {
  const Scene scene = plain();
  const cv::Mat image = scene.picture.expose(0.7, 1.0);
  for (int k = 0; k < 8; ++k) {
    const Eigen::Vector2d start = 0.7 * Eigen::Vector2d(std::cos(k * 45.0 * kDegree), std::sin(k * 45.0 * kDegree));
    const auto found = errors(scene, image, start);
    EXPECT_GE(found.size(), 140U);
    EXPECT_LT(rms(found), 0.02);
  }
}

TEST(RefineBySymmetry, endsAtTheSamePointWhereverItStarts) {
  const Scene scene = plain();
  const cv::Mat image = scene.picture.expose(0.7, 3.0);
  const TrueCorner& corner = scene.corners.at(60);
  const auto one = refineBySymmetry(image, corner.px + Eigen::Vector2d(0.5, 0.2), scene.mapAround(60), options());
  const auto other = refineBySymmetry(image, corner.px - Eigen::Vector2d(0.3, 0.4), scene.mapAround(60), options());
  ASSERT_TRUE(one && other);
  EXPECT_LT((one->px - other->px).norm(), 0.005);
}

TEST(RefineBySymmetry, isNotBiasedByBentLines) {
  const Scene scene(test_support::fisheyeCamera(700, 700, 210.0),
                    {0.30, 60.0 * kDegree, 0.6, 5.0 * kDegree, 10.0 * kDegree, 0.2});
  const cv::Mat image = scene.picture.expose(0.7, 0.5);
  std::vector<double> normalised;
  for (const TrueCorner& corner : scene.corners) {
    const auto refined = refineBySymmetry(image, corner.px, scene.mapAround(corner.corner_id), options());
    ASSERT_TRUE(refined) << corner.corner_id;
    const Eigen::Vector2d error_px = refined->px - corner.px;
    normalised.push_back(std::sqrt(0.5 * error_px.dot(refined->cov_px2.inverse() * error_px)));
  }
  EXPECT_LT(rms(normalised), 1.25);  // an affine map of the board gives 2.9
}

/// Two edges that cross at `centre_px`, blurred by a smooth point spread function, with noise: no pixel grid but that of the
/// sampling. `J_px_board` px per tag side.
struct CrossedEdges {
  Eigen::Vector2d centre_px = Eigen::Vector2d(40.0, 40.0);
  Eigen::Matrix2d J_px_board = (Eigen::Matrix2d() << 60.0, 8.0, -5.0, 50.0).finished();
  double blur_px = 0.7;
  double noise_grey = 0.0;
  double light_slope_per_px = 0.0;  ///< along x, relative to the light at the centre

  cv::Mat1b draw(cv::RNG& random) const {
    constexpr double kStep_px = 0.01;
    const Eigen::Matrix2d to_board = J_px_board.inverse();
    const Eigen::Vector2d px_per_board = to_board.rowwise().norm().cwiseInverse();
    const double width_px = std::sqrt(2.0) * blur_px;
    const auto reflected = [&](double x, double y) {
      const Eigen::Vector2d across_px = (to_board * (Eigen::Vector2d(x, y) - centre_px)).cwiseProduct(px_per_board);
      return 120.0 + 70.0 * std::erf(across_px.x() / width_px) * std::erf(across_px.y() / width_px);
    };
    cv::Mat1b image(81, 81);
    for (int y = 0; y < image.rows; ++y) {
      for (int x = 0; x < image.cols; ++x) {
        // A product with x, blurred, is x times the blurred, plus the variance of the blur times its slope.
        const double slope = (reflected(x + kStep_px, y) - reflected(x - kStep_px, y)) / (2.0 * kStep_px);
        const double light =
            reflected(x, y) + light_slope_per_px * ((x - centre_px.x()) * reflected(x, y) + blur_px * blur_px * slope);
        image(y, x) = cv::saturate_cast<std::uint8_t>(light + random.gaussian(noise_grey));
      }
    }
    return image;
  }

  BoardToPixelOffset map() const {
    return [J = J_px_board](const Eigen::Vector2d& offset) { return Eigen::Vector2d(J * offset); };
  }
};

/// Calls `check` with the corner as refined, for places all over a pixel and edges of several directions.
void forPlacesWithinAPixel(CrossedEdges edges,
                           const std::function<void(const RefinedCorner&, const Eigen::Vector2d&)>& check) {
  cv::RNG random(7);
  const Eigen::Matrix2d J_px_board = edges.J_px_board;
  constexpr int kPlaces = 10;
  for (int k = 0; k < 4 * kPlaces * kPlaces; ++k) {
    const int row = k / kPlaces;
    edges.centre_px = Eigen::Vector2d(40.0 + 0.1 * (k % kPlaces), 40.0 + 0.1 * (row % kPlaces));
    const int direction = k / (kPlaces * kPlaces);
    edges.J_px_board = Eigen::Rotation2Dd(0.3 * direction).toRotationMatrix() * J_px_board;
    const auto refined =
        refineBySymmetry(edges.draw(random), edges.centre_px + Eigen::Vector2d(0.2, -0.15), edges.map(), {});
    ASSERT_TRUE(refined);
    check(*refined, refined->px - edges.centre_px);
  }
}

TEST(RefineBySymmetry, doesNotFeelThePixelGrid) {
  for (const double blur_px : {0.5, 0.7, 1.2}) {
    std::vector<double> found;
    CrossedEdges edges;
    edges.blur_px = blur_px;
    forPlacesWithinAPixel(edges, [&](const RefinedCorner&, const Eigen::Vector2d& error) { found.push_back(error.norm()); });
    EXPECT_LT(rms(found), 0.0022) << blur_px;  // rounding the grey values costs 0.0013
  }
}

TEST(RefineBySymmetry, statesTheCovarianceThatItsErrorsHave) {
  for (const double blur_px : {0.6, 1.0, 2.0}) {
    std::vector<double> normalised;
    CrossedEdges edges;
    edges.blur_px = blur_px;
    edges.noise_grey = 3.0;
    forPlacesWithinAPixel(edges, [&](const RefinedCorner& corner, const Eigen::Vector2d& error_px) {
      normalised.push_back(std::sqrt(0.5 * error_px.dot(corner.cov_px2.inverse() * error_px)));
    });
    EXPECT_NEAR(rms(normalised), 1.0, 0.1) << blur_px;  // of 400 corners: 1.00 +- 0.025
  }
}

TEST(RefineBySymmetry, takesWhatTheImageBorderLeaves) {
  CrossedEdges edges;
  edges.noise_grey = 2.0;
  cv::RNG random(3);
  for (const double to_border_px : {2.0, 3.5, 6.0}) {
    const cv::Mat1b image = edges.draw(random).colRange(40 - static_cast<int>(to_border_px), 81).clone();
    const Eigen::Vector2d truth_px = edges.centre_px - Eigen::Vector2d(40.0 - std::floor(to_border_px), 0.0);
    const auto refined = refineBySymmetry(image, truth_px + Eigen::Vector2d(0.1, 0.2), edges.map(), {});
    ASSERT_TRUE(refined) << to_border_px;
    const Eigen::Vector2d error_px = refined->px - truth_px;
    EXPECT_LT(error_px.norm(), 0.06) << to_border_px;
    EXPECT_LT(error_px.dot(refined->cov_px2.inverse() * error_px), 13.8) << to_border_px;  // 99.9 % of chi-square, 2 axes
  }
}

TEST(RefineBySymmetry, leavesOutWhatCoversTheRimOfTheWindow) {
  CrossedEdges edges;
  edges.noise_grey = 2.0;
  cv::RNG random(3);
  cv::Mat1b image = edges.draw(random);
  const auto clear = refineBySymmetry(image, edges.centre_px, edges.map(), {});
  image.colRange(46, 81) = 10;  // the window reaches to 49
  const auto covered = refineBySymmetry(image, edges.centre_px, edges.map(), {});
  ASSERT_TRUE(clear && covered);
  EXPECT_LT((covered->px - edges.centre_px).norm(), 0.06);
  EXPECT_GT(covered->cov_px2.trace(), clear->cov_px2.trace());
}

TEST(RefineBySymmetry, isNotPulledByASlopeOfLight) {
  Scene scene = plain();
  for (int y = 0; y < 480; ++y) {
    for (int x = 0; x < 640; ++x) {
      scene.picture.grey()(y, x) *= static_cast<float>(1.0 + 0.01 * (x % 40 - 20));  // 1 % a pixel, 40 pixels at a time
    }
  }
  const cv::Mat image = scene.picture.expose(0.7, 0.5);
  std::vector<double> found;
  for (const TrueCorner& corner : scene.corners) {
    const int phase = static_cast<int>(corner.px.x()) % 40;
    if (phase < 11 || phase > 28) {
      continue;  // the light jumps within the window
    }
    const auto refined = refineBySymmetry(image, corner.px, scene.mapAround(corner.corner_id), options());
    ASSERT_TRUE(refined);
    found.push_back((refined->px - corner.px).norm());
  }
  ASSERT_GT(found.size(), 30U);
  EXPECT_LT(rms(found), 0.02);
}

TEST(RefineBySymmetry, isNotPulledByWhatBlurMakesOfASlopeOfLight) {
  CrossedEdges edges;
  edges.blur_px = 0.5;
  edges.light_slope_per_px = 0.03;  // as near the rim of a wide lens
  double sum_px = 0.0;
  int count = 0;
  forPlacesWithinAPixel(edges, [&](const RefinedCorner&, const Eigen::Vector2d& error_px) {
    sum_px += error_px.x();
    ++count;
  });
  // The point spread is not known: a variance of 0.25 px^2 instead of a pixel's 0.08 leaves 0.005; the spline alone pulls by
  // 0.010 more.
  EXPECT_NEAR(sum_px / count, 0.0, 0.006);
}

TEST(RefineBySymmetry, statesMoreUncertaintyWhereThereIsMoreNoise) {
  const Scene scene = plain();
  double sigma_px[2] = {};
  for (const int i : {0, 1}) {
    const auto refined = refineBySymmetry(scene.picture.expose(0.8, i == 0 ? 4.0 : 12.0), scene.corners.at(70).px,
                                          scene.mapAround(70), options());
    ASSERT_TRUE(refined);
    sigma_px[i] = std::sqrt(0.5 * refined->cov_px2.trace());
    EXPECT_GT(refined->cov_px2.determinant(), 0.0);
  }
  EXPECT_GT(sigma_px[1], 1.7 * sigma_px[0]);
}

TEST(RefineBySymmetry, givesNothingWhereNoCornerIs) {
  const Scene scene = plain();
  const cv::Mat image = scene.picture.expose(0.7, 1.0);
  const BoardToPixelOffset square = [](const Eigen::Vector2d& offset) { return Eigen::Vector2d(500.0 * offset); };
  const BoardToPixelOffset broken = [](const Eigen::Vector2d&) {
    return Eigen::Vector2d::Constant(std::numeric_limits<double>::quiet_NaN()).eval();
  };
  const BoardToPixelOffset huge = [](const Eigen::Vector2d& offset) { return Eigen::Vector2d(1e9 * offset.array() + 1e9); };
  const BoardToPixelOffset point = [](const Eigen::Vector2d&) { return Eigen::Vector2d::Zero().eval(); };
  const Eigen::Vector2d corner_px = scene.corners.at(60).px;
  EXPECT_FALSE(refineBySymmetry(cv::Mat(200, 200, CV_8UC1, cv::Scalar(90)), {100.0, 100.0}, square, options()));
  EXPECT_FALSE(refineBySymmetry(image, {1.0, 100.0}, square, options()));
  EXPECT_FALSE(refineBySymmetry(image, {639.0, 479.0}, square, options()));
  EXPECT_FALSE(refineBySymmetry(image, {-50.0, 9999.0}, square, options()));
  EXPECT_FALSE(refineBySymmetry(image, corner_px, broken, options()));
  EXPECT_FALSE(refineBySymmetry(image, corner_px, huge, options()));
  EXPECT_FALSE(refineBySymmetry(image, corner_px, point, options()));
  cv::Mat wedge(100, 100, CV_8UC1, cv::Scalar(200));
  cv::rectangle(wedge, {50, 50}, {99, 99}, cv::Scalar(20), cv::FILLED);
  EXPECT_FALSE(refineBySymmetry(wedge, {49.5, 49.5}, square, options()));
}

TEST(RefineBySymmetry, givesNothingFurtherAwayThanAllowed) {
  const Scene scene = plain();
  const cv::Mat image = scene.picture.expose(0.7, 1.0);
  RefineOptions narrow = options();
  narrow.max_shift_px = 0.3;
  const Eigen::Vector2d start_px = scene.corners.at(60).px + Eigen::Vector2d(0.5, 0.0);
  EXPECT_FALSE(refineBySymmetry(image, start_px, scene.mapAround(60), narrow));
}

}  // namespace
}  // namespace tartan_calib::detection
