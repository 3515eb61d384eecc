#include "tartan_calib/simulation/lens.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tartan_calib/error.h"

namespace tartan_calib::simulation {
namespace {

/// Degrees between the rays of two pixels.
double degreesBetween(const camera::CameraModel& model, const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return std::acos(camera::unproject(model, a)->dot(*camera::unproject(model, b))) * 180.0 / M_PI;
}

double degreesAcross(const SceneCamera& lens) {
  const double v = 0.5 * (lens.camera.height - 1);
  const double centre = 0.5 * (lens.camera.width - 1);
  const double reach = std::min(lens.image_circle_px, 0.5 * lens.camera.width);
  // In two halves, since the angle between rays stops at 180.
  return degreesBetween(lens.camera.model, {centre - reach, v}, {centre, v}) +
         degreesBetween(lens.camera.model, {centre, v}, {centre + reach, v});
}

TEST(MakeLens, hasTheFieldOfViewInItsName) {
  for (const std::string model : {"ds-none", "pinhole-equi", "eucm-none"}) {
    for (const auto& [name, degrees] : std::vector<std::pair<std::string, double>>{
             {"fisheye100", 100.0}, {"fisheye190", 190.0}, {"bf5m195", 195.0}, {"gopro150", 122.6}, {"pinhole70", 70.0}}) {
      LensRequest request;
      request.lens = name;
      request.model = model;
      EXPECT_NEAR(degreesAcross(makeLens(request)), degrees, 0.01 * degrees) << name << " " << model;
    }
  }
}

TEST(MakeLens, fitsANarrowLensWithEveryModel) {
  for (const std::string& model : camera::modelNames()) {
    LensRequest request;
    request.lens = "pinhole60";
    request.model = model;
    EXPECT_NEAR(degreesAcross(makeLens(request)), 60.0, 0.6) << model;
  }
}

TEST(MakeLens, keepsTheFieldOfViewAtAnotherResolution) {
  LensRequest request;
  request.lens = "bf5m195";
  request.width = 612;
  request.height = 512;
  const SceneCamera lens = makeLens(request);
  EXPECT_EQ(lens.camera.width, 612);
  EXPECT_NEAR(lens.image_circle_px, 280.0, 1e-9);
  EXPECT_NEAR(degreesAcross(lens), 195.0, 2.0);
}

TEST(MakeLens, refusesWhatIsNoLensAndModelsThatCannotShowIt) {
  for (const std::string name : {"fisheye", "fisheye999", "pinhole170", "plenoptic", "xfisheye190"}) {
    LensRequest request;
    request.lens = name;
    EXPECT_THROW(makeLens(request), InputError) << name;
  }
  for (const std::string model : {"pinhole-radtan", "pinhole-none", "no-model"}) {
    LensRequest request;
    request.model = model;
    EXPECT_THROW(makeLens(request), InputError) << model;
  }
}

TEST(AnotherPiece, differsALittleFromPieceToPiece) {
  const SceneCamera lens = makeLens({});
  const Eigen::VectorXd first = camera::parameters(anotherPiece(lens, 1).camera.model);
  EXPECT_EQ(first, camera::parameters(anotherPiece(lens, 1).camera.model));
  const Eigen::VectorXd second = camera::parameters(anotherPiece(lens, 2).camera.model);
  EXPECT_GT((first - second).norm(), 0.1);
  EXPECT_LT((first - second).norm(), 40.0);
}

}  // namespace
}  // namespace tartan_calib::simulation
