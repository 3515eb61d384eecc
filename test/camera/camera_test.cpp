#include "tartan_calib/camera/camera.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tartan_calib/error.h"

namespace tartan_calib::camera {
namespace {

Eigen::Vector3d direction(double polar_rad) {
  return {std::sin(polar_rad) * 0.6, std::sin(polar_rad) * 0.8, std::cos(polar_rad)};
}

CameraModel model(const std::string& name, std::initializer_list<double> list) {
  return withParameters(modelByName(name),
                        Eigen::Map<const Eigen::VectorXd>(list.begin(), static_cast<Eigen::Index>(list.size())));
}

/// Where both models are the same lens, at angles up to `limit_rad`.
void expectSameImages(const CameraModel& a, const CameraModel& b, double limit_rad, double tolerance_px) {
  for (double polar = 0.0; polar < limit_rad; polar += 0.05) {
    const auto px_a = project(a, direction(polar));
    const auto px_b = project(b, direction(polar));
    ASSERT_TRUE(px_a && px_b) << modelName(a) << " and " << modelName(b) << " at " << polar;
    EXPECT_LT((*px_a - *px_b).norm(), tolerance_px) << modelName(a) << " and " << modelName(b) << " at " << polar;
  }
}

TEST(CameraTest, ModelsMeetInTheirLimits) {
  const CameraModel pinhole = model("pinhole-none", {400.0, 410.0, 320.0, 240.0});
  expectSameImages(model("ds-none", {0.0, 0.0, 400.0, 410.0, 320.0, 240.0}), pinhole, 1.5, 1e-9);
  expectSameImages(model("eucm-none", {0.0, 1.0, 400.0, 410.0, 320.0, 240.0}), pinhole, 1.5, 1e-9);
  expectSameImages(model("omni-none", {0.0, 400.0, 410.0, 320.0, 240.0}), pinhole, 1.5, 1e-9);
  expectSameImages(model("pinhole-radtan", {400.0, 410.0, 320.0, 240.0, 0.0, 0.0, 0.0, 0.0}), pinhole, 1.5, 1e-9);
  expectSameImages(model("pinhole-fov", {400.0, 410.0, 320.0, 240.0, 1e-3}), pinhole, 1.0, 1e-3);  // f rho^3 w^2 / 3
  const CameraModel omni = model("omni-none", {0.8, 600.0, 610.0, 320.0, 240.0});
  expectSameImages(model("omni-radtan", {0.8, 600.0, 610.0, 320.0, 240.0, 0.0, 0.0, 0.0, 0.0}), omni, 2.0, 1e-9);
  // Double sphere with alpha = 0 is the unified model; EUCM with beta = 1 is too, xi = alpha / (1 - alpha).
  expectSameImages(model("ds-none", {0.8, 0.0, 600.0, 610.0, 320.0, 240.0}), omni, 2.0, 1e-9);
  const double alpha = 0.8 / 1.8;
  expectSameImages(model("eucm-none", {alpha, 1.0, 600.0 * (1.0 - alpha), 610.0 * (1.0 - alpha), 320.0, 240.0}), omni, 2.0,
                   1e-9);
}

TEST(CameraTest, EquidistantWithoutCoefficientsIsProportionalToTheAngleBeyond90Degrees) {
  const CameraModel equidistant = model("pinhole-equi", {200.0, 200.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0});
  for (const double polar : {0.1, 1.0, 1.5707963267948966, 2.0, 3.0}) {
    const auto px = project(equidistant, direction(polar));
    ASSERT_TRUE(px);
    EXPECT_NEAR(px->norm(), 200.0 * polar, 1e-9);
  }
}

TEST(CameraTest, RadtanEqualsTheFormulaWrittenOut) {
  const double x = 0.3;
  const double y = -0.2;
  const double r2 = x * x + y * y;
  const double g = 1.0 - 0.2 * r2 + 0.13 * r2 * r2;
  const auto px =
      project(model("pinhole-radtan", {400.0, 410.0, 320.0, 240.0, -0.2, 0.13, 0.0005, 0.0007}), {2.0 * x, 2.0 * y, 2.0});
  ASSERT_TRUE(px);
  EXPECT_NEAR(px->x(), 400.0 * (x * g + 2 * 0.0005 * x * y + 0.0007 * (r2 + 2 * x * x)) + 320.0, 1e-9);
  EXPECT_NEAR(px->y(), 410.0 * (y * g + 2 * 0.0007 * x * y + 0.0005 * (r2 + 2 * y * y)) + 240.0, 1e-9);
}

TEST(CameraTest, RadtanHasNoImageBeyondItsFold) {
  // d(r g)/dr = 1 + 3 k1 r^2 with k1 = -0.28 vanishes at r = 1.0911.
  const CameraModel folded = model("pinhole-radtan", {400.0, 400.0, 320.0, 240.0, -0.28, 0.0, 0.0, 0.0});
  EXPECT_TRUE(project(folded, {1.09, 0.0, 1.0}));
  EXPECT_FALSE(project(folded, {1.092, 0.0, 1.0}));
  EXPECT_FALSE(unproject(folded, {320.0 + 400.0 * 0.8, 240.0}));
}

TEST(CameraTest, DoubleSphereSeesAsFarAsItsFormulaSays) {
  // eq. 43-45 with alpha = 0.59, xi = -0.18: w1 = 0.41 / 0.59.
  const double w1 = 0.41 / 0.59;
  const double limit = std::acos(-(w1 - 0.18) / std::sqrt(1.0 - 2.0 * w1 * 0.18 + 0.18 * 0.18));
  const CameraModel ds = model("ds-none", {-0.18, 0.59, 313.0, 313.0, 640.0, 512.0});
  EXPECT_TRUE(project(ds, direction(limit - 1e-3)));
  EXPECT_FALSE(project(ds, direction(limit + 1e-3)));
}

TEST(CameraTest, UnknownNamesAreAnsweredWithTheKnownOnes) {
  try {
    modelByName("fisheye");
    FAIL() << "accepted";
  } catch (const InputError& error) {
    EXPECT_EQ(std::string(error.what()),
              "Unknown camera model: fisheye. Try [pinhole-none, pinhole-radtan, pinhole-equi, pinhole-fov, omni-none, "
              "omni-radtan, "
              "eucm-none, ds-none].");
  }
  EXPECT_THROW(modelByKalibrNames("pinhole", "thin"), InputError);
  EXPECT_THROW(withParameters(modelByName("ds-none"), Eigen::VectorXd::Zero(5)), Error);
}

TEST(CameraTest, APixelIsInsideWhereItsCentreIsLessThanHalfAPixelOutside) {
  const Camera camera{modelByName("pinhole-none"), 640, 480};
  EXPECT_TRUE(isInside(camera, {-0.5, 0.0}));
  EXPECT_FALSE(isInside(camera, {-0.51, 0.0}));
  EXPECT_TRUE(isInside(camera, {639.49, 479.49}));
  EXPECT_FALSE(isInside(camera, {639.5, 0.0}));
}

}  // namespace
}  // namespace tartan_calib::camera
