#include "tartan_calib/calibration/validate.h"

#include <gtest/gtest.h>

#include "solve_scenes.h"

namespace tartan_calib::calibration {
namespace {

Rig withFocalLengths(Rig rig, std::size_t camera_index, double ratio) {
  camera::CameraModel& model = rig.cameras[camera_index].camera.model;
  Eigen::VectorXd parameters = camera::parameters(model);
  parameters.segment<2>(camera::focalIndex(model)) *= ratio;
  model = camera::withParameters(model, parameters);
  return rig;
}

struct RigErrors {
  std::vector<CameraErrors> together;
  std::vector<CameraErrors> alone;
};

RigErrors validate(const Rig& rig, const Scene& scene, const std::vector<observation::View>& views) {
  std::vector<std::vector<ImageErrors>> together(rig.cameras.size());
  std::vector<std::vector<ImageErrors>> alone(rig.cameras.size());
  for (const observation::View& view : views) {
    const ViewErrors errors = validateView(rig, scene.target_points, view);
    for (const ImageErrors& image : errors.together) {
      together[static_cast<std::size_t>(image.camera_index)].push_back(image);
    }
    for (const ImageErrors& image : errors.alone) {
      alone[static_cast<std::size_t>(image.camera_index)].push_back(image);
    }
  }
  RigErrors errors;
  for (std::size_t i = 0; i < rig.cameras.size(); ++i) {
    errors.together.push_back(summarizeErrors(together[i]));
    errors.alone.push_back(summarizeErrors(alone[i]));
  }
  return errors;
}

TEST(Validate, TheTruthPredictsExactCornersAndTheirPoses) {
  const Scene scene = sceneOf({"ds-none", "pinhole-radtan"}, 12);
  for (std::size_t i = 0; i < scene.views.size(); ++i) {
    const ViewErrors errors = validateView(scene.rig, scene.target_points, scene.views[i]);
    ASSERT_EQ(errors.together.size(), scene.views[i].cameras.size());
    EXPECT_EQ(errors.stamp_ns, scene.views[i].stamp_ns);
    for (const ImageErrors& image : errors.together) {
      EXPECT_LT(summarizeCorners(image.corners).max_px, 1e-4);
      const RigCamera& camera = scene.rig.cameras[static_cast<std::size_t>(image.camera_index)];
      const geometry::Rigid3 T_cam_target = camera.T_cam_rig * scene.T_rig_target[i];
      EXPECT_LT((image.T_cam_target.translation - T_cam_target.translation).norm(), 1e-6);
    }
  }
}

TEST(Validate, ErrorsOfTheTruthAreTheNoiseOfTheCorners) {
  const Scene scene = sceneOf({"ds-none"}, 40);
  const Problem noisy = noisyProblem(scene, kNoise_px, 3);
  const CameraErrors camera = validate(scene.rig, scene, noisy.views).together.front();
  // Six of some 200 measurements of a view go into its pose. Rayleigh: median 1.177 sigma, 95 % 2.448 sigma.
  EXPECT_NEAR(camera.errors.rms_px, std::sqrt(2.0) * kNoise_px, 0.05 * kNoise_px);
  EXPECT_NEAR(camera.errors.median_px, 1.177 * kNoise_px, 0.05 * kNoise_px);
  EXPECT_NEAR(camera.errors.percentile95_px, 2.448 * kNoise_px, 0.1 * kNoise_px);
  EXPECT_LT(camera.errors.mean_px.norm(), 0.02 * kNoise_px);
  EXPECT_EQ(camera.num_images, 40);
  EXPECT_EQ(camera.num_wrong, 0);
}

TEST(Validate, AWrongLensShowsInItsOwnCameraOnly) {
  const Scene scene = sceneOf({"ds-none", "ds-none"}, 20);
  const RigErrors errors = validate(withFocalLengths(scene.rig, 1, 1.01), scene, scene.views);
  EXPECT_LT(errors.alone[0].errors.rms_px, 1e-3);
  EXPECT_GT(errors.alone[1].errors.rms_px, 0.1);
}

TEST(Validate, WrongExtrinsicsShowInTheCommonPoseOnly) {
  const Scene scene = sceneOf({"ds-none", "ds-none"}, 20);
  Rig moved = scene.rig;
  moved.cameras[1].T_cam_rig.translation.x() += 2e-3;
  const RigErrors errors = validate(moved, scene, scene.views);
  for (std::size_t i = 0; i < moved.cameras.size(); ++i) {
    EXPECT_LT(errors.alone[i].errors.rms_px, 1e-3);
    EXPECT_GT(errors.together[i].errors.rms_px, 0.1);
  }
}

TEST(Validate, CornersDetectedWronglyAreCountedAndDoNotCount) {
  const Scene scene = sceneOf({"ds-none"}, 20);
  Problem noisy = noisyProblem(scene, kNoise_px, 3);
  const int num_wrong = test_support::addWrongCorners(noisy.views, 0.02, 40.0, 5);
  const CameraErrors camera = validate(scene.rig, scene, noisy.views).together.front();
  EXPECT_NEAR(camera.num_wrong, num_wrong, 0.05 * num_wrong + 1.0);
  EXPECT_LT(camera.errors.rms_px, 1.1 * std::sqrt(2.0) * kNoise_px);
}

TEST(Validate, ALensThatIsWrongAtTheRimHasNoWrongCornersThere) {
  // Another shape behind the same scale in the middle: errors that grow smoothly to the rim are the lens's own.
  const Scene scene = sceneOf({"ds-none"}, 20);
  const Problem noisy = noisyProblem(scene, 0.02, 3);
  Rig bent = scene.rig;
  Eigen::VectorXd parameters = camera::parameters(bent.cameras[0].camera.model);
  parameters(1) += 0.01;
  bent.cameras[0].camera.model = camera::withParameters(bent.cameras[0].camera.model, parameters);
  const CameraErrors camera = validate(bent, scene, noisy.views).together.front();
  EXPECT_GT(camera.errors.max_px, 5.0 * camera.errors.median_px);
  EXPECT_LT(camera.num_wrong, 0.002 * camera.errors.num_corners);
}

TEST(Validate, BandsOfPolarAngleHoldAllCorners) {
  const Scene scene = sceneOf({"ds-none"}, 20);
  const CameraErrors camera = validate(withFocalLengths(scene.rig, 0, 1.01), scene, scene.views).alone.front();
  int num_corners = 0;
  for (std::size_t i = 0; i < camera.bands.size(); ++i) {
    EXPECT_DOUBLE_EQ(camera.bands[i].from_rad, static_cast<double>(i) * M_PI / 18.0);
    num_corners += camera.bands[i].errors.num_corners;
  }
  EXPECT_EQ(num_corners, camera.errors.num_corners);
  EXPECT_LE(camera.bands.back().from_rad, camera.max_polar_rad);
  EXPECT_GT(camera.bands.back().to_rad, camera.max_polar_rad);
}

TEST(Validate, AViewThatNoPoseExplainsHasNoErrors) {
  const Scene scene = sceneOf({"ds-none"}, 1);
  observation::View view = scene.views.front();
  view.cameras.front().corners.resize(3);
  const ViewErrors errors = validateView(scene.rig, scene.target_points, view);
  EXPECT_TRUE(errors.together.empty());
  EXPECT_TRUE(errors.alone.empty());
  EXPECT_TRUE(validateView(scene.rig, scene.target_points, {}).together.empty());
  EXPECT_EQ(summarizeErrors({}).errors.num_corners, 0);
}

}  // namespace
}  // namespace tartan_calib::calibration
