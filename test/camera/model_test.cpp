#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <variant>
#include <vector>

#include "tartan_calib/camera/camera.h"

namespace tartan_calib::camera {
namespace {

using ParameterSets = std::vector<std::vector<double>>;

/// Parameter sets per model: mild ones, those of real lenses, and ones near the ends of the parameters' range.
template <class ModelType>
ParameterSets parameterSets();

template <>
ParameterSets parameterSets<PinholeNone>() {
  return {{400.0, 410.0, 319.5, 239.5}};
}
template <>
ParameterSets parameterSets<PinholeRadtan>() {
  return {{400.0, 400.0, 319.5, 239.5, 0.0, 0.0, 0.0, 0.0},
          {400.0, 410.0, 320.0, 240.0, -0.2, 0.13, 0.0005, 0.0005},
          {458.654, 457.296, 367.215, 248.375, -0.28340811, 0.07395907, 0.00019359, 1.76187e-5},
          {500.0, 500.0, 320.0, 240.0, 0.3, 0.1, -0.002, 0.003}};
}
template <>
ParameterSets parameterSets<PinholeEqui>() {
  return {{300.0, 300.0, 511.5, 383.5, 0.0, 0.0, 0.0, 0.0},
          {380.0, 381.0, 512.0, 384.0, -0.00185, 0.01901, -0.02422, 0.01429},
          {190.0, 190.5, 254.9, 256.9, 0.0034, 0.0007, -0.0020, 0.0002},
          {350.0, 350.0, 640.0, 480.0, -0.05, -0.01, 0.002, -0.0005}};
}
template <>
ParameterSets parameterSets<PinholeFov>() {
  return {{400.0, 400.0, 320.0, 240.0, 1.0}, {300.0, 310.0, 320.0, 240.0, 0.3}, {300.0, 300.0, 320.0, 240.0, 1.5}};
}
template <>
ParameterSets parameterSets<OmniNone>() {
  return {{0.0, 400.0, 400.0, 320.0, 240.0},
          {0.9, 600.0, 610.0, 320.0, 240.0},
          {1.0, 700.0, 700.0, 320.0, 240.0},
          {1.8, 800.0, 805.0, 320.0, 240.0}};
}
template <>
ParameterSets parameterSets<OmniRadtan>() {
  return {{0.9, 600.0, 610.0, 320.0, 240.0, -0.1, 0.02, 0.001, -0.001},
          {1.826, 793.26, 791.0, 322.3, 236.8, -0.04435, 0.19035, -1.1e-05, 3.4e-05}};
}
template <>
ParameterSets parameterSets<Eucm>() {
  return {{0.0, 1.0, 400.0, 400.0, 320.0, 240.0},
          {0.63, 1.04, 380.0, 385.0, 640.0, 512.0},
          {0.45, 1.3, 300.0, 300.0, 640.0, 512.0},
          {0.6, 0.5, 300.0, 300.0, 640.0, 512.0}};
}
template <>
ParameterSets parameterSets<DoubleSphere>() {
  return {{0.0, 0.0, 400.0, 400.0, 320.0, 240.0},
          {-0.18, 0.59, 313.0, 314.0, 640.0, 512.0},
          {-0.27, 0.57, 364.84, 364.86, 640.0, 512.0},
          {0.5, 0.3, 500.0, 500.0, 640.0, 512.0},
          {-0.21105, 0.56984, 158.27, 157.97, 318.6, 242.2}};
}

Eigen::Vector3d direction(double polar_rad, double azimuth_rad) {
  return {std::sin(polar_rad) * std::cos(azimuth_rad), std::sin(polar_rad) * std::sin(azimuth_rad), std::cos(polar_rad)};
}

/// Largest polar angle along an azimuth up to which every direction projects, to 1e-4 rad.
double edgeOfValidity(const CameraModel& model, double azimuth_rad) {
  constexpr double kStep_rad = 1e-4;
  double polar = 0.0;
  while (polar < M_PI && project(model, direction(polar + kStep_rad, azimuth_rad))) {
    polar += kStep_rad;
  }
  return polar;
}

Eigen::Vector2d principalPoint(const CameraModel& model) { return parameters(model).segment<2>(focalIndex(model) + 2); }

constexpr double kAzimuths_rad[] = {0.0, 0.7, 2.1, M_PI, 4.0, 5.5};

void expectRaysToReturnUpToTheEdgeOfValidity(const CameraModel& model) {
  for (const double azimuth : kAzimuths_rad) {
    const double edge = edgeOfValidity(model, azimuth);
    ASSERT_GT(edge, 0.5);
    for (const double share : {0.0, 1e-9, 1e-4, 0.1, 0.5, 0.9, 0.99}) {
      const Eigen::Vector3d ray = direction(share * edge, azimuth);
      const auto px = project(model, 3.0 * ray);
      ASSERT_TRUE(px);
      const auto back = unproject(model, *px);
      ASSERT_TRUE(back) << "polar " << share * edge;
      // 1e-8 rad is 1e-5 px; near a fold the image stands still and the ray follows less precisely.
      EXPECT_LT((*back - ray).norm(), share < 0.95 ? 1e-8 : 1e-6) << "polar " << share * edge;
    }
  }
}

void expectPixelsToReturn(const CameraModel& model) {
  int rays = 0;
  for (double u = -300.0; u <= 300.0; u += 50.0) {
    for (double v = -300.0; v <= 300.0; v += 50.0) {
      const Eigen::Vector2d px = principalPoint(model) + Eigen::Vector2d(u, v);
      const auto ray = unproject(model, px);
      if (!ray) {
        continue;
      }
      ++rays;
      EXPECT_NEAR(ray->norm(), 1.0, 1e-12);
      if (const auto back = project(model, *ray)) {
        EXPECT_LT((*back - px).norm(), 1e-6) << "at " << px.transpose();
      } else {
        // Only at the very rim may a pixel have a ray that lies in the margin of the validity test.
        const double polar = std::atan2(ray->head<2>().norm(), ray->z());
        EXPECT_GT(polar + 2e-3, edgeOfValidity(model, std::atan2(ray->y(), ray->x())));
      }
    }
  }
  EXPECT_GT(rays, 40);
}

void expectTheImageRadiusToGrowWithTheAngleUpToTheEdge(const CameraModel& model) {
  const double edge = edgeOfValidity(model, 0.3);
  double last = -1.0;
  for (double polar = 0.0; polar < edge; polar += 0.01) {
    const auto px = project(model, direction(polar, 0.3));
    ASSERT_TRUE(px);
    const double radius = (*px - principalPoint(model)).norm();
    EXPECT_GT(radius, last) << "polar " << polar;
    last = radius;
  }
}

void expectTheSameImageAtAnyDistance(const CameraModel& model) {
  const Eigen::Vector3d p = direction(0.6, 1.0);
  const auto near = project(model, 0.01 * p);
  const auto far = project(model, 1000.0 * p);
  ASSERT_TRUE(near && far);
  EXPECT_LT((*near - *far).norm(), 1e-9);
}

/// The difference quotient carries about 1e-10 px / 1e-6 of rounding and a relative 1e-6 of curvature.
void expectDerivative(const Eigen::Vector2d& analytic, const Eigen::Vector2d& numeric) {
  EXPECT_LT((analytic - numeric).norm(), 1e-5 * (10.0 + numeric.norm()))
      << "analytic " << analytic.transpose() << " numeric " << numeric.transpose();
}

void expectThePointJacobianToEqualCentralDifferences(const CameraModel& model) {
  constexpr double kStep = 1e-6;
  for (const double azimuth : kAzimuths_rad) {
    const double edge = edgeOfValidity(model, azimuth);
    for (const double share : {0.0, 1e-8, 1e-3, 0.3, 0.7, 0.9}) {
      SCOPED_TRACE("polar " + std::to_string(share * edge));
      const Eigen::Vector3d p = 0.7 * direction(share * edge, azimuth);
      Matrix23d J;
      ASSERT_TRUE(project(model, p, &J));
      for (int i = 0; i < 3; ++i) {
        const Eigen::Vector3d step = kStep * Eigen::Vector3d::Unit(i);
        const auto plus = project(model, p + step);
        const auto minus = project(model, p - step);
        ASSERT_TRUE(plus && minus);
        expectDerivative(J.col(i), (*plus - *minus) / (2.0 * kStep));
      }
    }
  }
}

void expectTheParameterJacobianToEqualCentralDifferences(const CameraModel& model) {
  for (const double share : {0.0, 0.3, 0.7, 0.9}) {
    const Eigen::Vector3d p = 0.7 * direction(share * edgeOfValidity(model, 2.1), 2.1);
    ParameterJacobian J;
    ASSERT_TRUE(project(model, p, nullptr, &J));
    for (int i = 0; i < numParameters(model); ++i) {
      SCOPED_TRACE("parameter " + std::to_string(i));
      Eigen::VectorXd moved = parameters(model);
      const double value = moved(i);
      const double step = 1e-6 * std::max(1.0, std::abs(value));
      moved(i) = value + step;
      const auto plus = project(withParameters(model, moved), p);
      moved(i) = value - step;
      const auto minus = project(withParameters(model, moved), p);
      ASSERT_TRUE(plus && minus);
      expectDerivative(J.col(i), (*plus - *minus) / (2.0 * step));
    }
  }
}

void expectTheAskedScaleOfAStart(const CameraModel& model) {
  const CameraModel start = startModel(model, 250.0, Eigen::Vector2d(100.0, 80.0));
  const auto axis = project(start, Eigen::Vector3d::UnitZ());
  const auto beside = project(start, direction(1e-4, 0.0));
  ASSERT_TRUE(axis && beside);
  EXPECT_EQ(*axis, Eigen::Vector2d(100.0, 80.0));
  EXPECT_NEAR((*beside - *axis).norm() / 1e-4, 250.0, 1e-3);
}

void expectToLieWithinTheBounds(const CameraModel& model) {
  const Eigen::VectorXd values = parameters(model);
  for (int i = 0; i < numParameters(model); ++i) {
    EXPECT_GE(values(i), lowerBound(model)(i)) << "parameter " << i;
    EXPECT_LE(values(i), upperBound(model)(i)) << "parameter " << i;
  }
}

void expectNamesToLeadBack(const CameraModel& model) {
  EXPECT_EQ(modelByName(modelName(model)).index(), model.index());
  EXPECT_EQ(modelByKalibrNames(kalibrModel(model), kalibrDistortion(model)).index(), model.index());
}

void expectPointsWithoutAnImageToBeReportedAndToLeaveThePixelAlone(const CameraModel& model) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const Eigen::Vector3d& p :
       {Eigen::Vector3d(0.0, 0.0, -1.0), Eigen::Vector3d(0.0, 0.0, 0.0), Eigen::Vector3d(nan, 0.0, 1.0)}) {
    Eigen::Vector2d px(-7.0, -8.0);
    EXPECT_FALSE(std::visit([&](const auto& lens) { return lens.project(p, px); }, model)) << "p " << p.transpose();
    EXPECT_EQ(px, Eigen::Vector2d(-7.0, -8.0));
  }
}

/// Expects a property of a model with each of these sets of parameters.
void expectOfAll(const std::string& name, const ParameterSets& sets, void (*expect)(const CameraModel&)) {
  for (const std::vector<double>& set : sets) {
    const Eigen::VectorXd values = Eigen::VectorXd::Map(set.data(), static_cast<Eigen::Index>(set.size()));
    const CameraModel model = withParameters(modelByName(name), values);
    EXPECT_EQ(parameters(model), values);
    SCOPED_TRACE(testing::PrintToString(set));
    expect(model);
  }
}

template <class ModelType>
class ModelTest : public testing::Test {
 protected:
  static void expectOfAll(void (*expect)(const CameraModel&)) {
    camera::expectOfAll(ModelType::kName, parameterSets<ModelType>(), expect);
  }
};

template <class Variant>
struct KindsOf;
template <class... Kinds>
struct KindsOf<std::variant<Kinds...>> {
  using Types = testing::Types<Kinds...>;
};

TYPED_TEST_SUITE(ModelTest, KindsOf<CameraModel>::Types);

TYPED_TEST(ModelTest, RayToPixelToRayHoldsUpToTheEdgeOfValidity) {
  this->expectOfAll(expectRaysToReturnUpToTheEdgeOfValidity);
}
TYPED_TEST(ModelTest, PixelToRayToPixelReturns) { this->expectOfAll(expectPixelsToReturn); }
TYPED_TEST(ModelTest, ImageRadiusGrowsWithTheAngleUpToTheEdge) {
  this->expectOfAll(expectTheImageRadiusToGrowWithTheAngleUpToTheEdge);
}
TYPED_TEST(ModelTest, ProjectionDoesNotDependOnTheDistance) { this->expectOfAll(expectTheSameImageAtAnyDistance); }
TYPED_TEST(ModelTest, PointJacobianEqualsCentralDifferences) {
  this->expectOfAll(expectThePointJacobianToEqualCentralDifferences);
}
TYPED_TEST(ModelTest, ParameterJacobianEqualsCentralDifferences) {
  this->expectOfAll(expectTheParameterJacobianToEqualCentralDifferences);
}
TYPED_TEST(ModelTest, PointsWithoutAnImageAreReportedAndLeaveThePixelAlone) {
  this->expectOfAll(expectPointsWithoutAnImageToBeReportedAndToLeaveThePixelAlone);
}
TYPED_TEST(ModelTest, StartHasTheAskedScaleInTheCentre) { this->expectOfAll(expectTheAskedScaleOfAStart); }
TYPED_TEST(ModelTest, BoundsContainTheStartAndTheSetsOfRealLenses) { this->expectOfAll(expectToLieWithinTheBounds); }
TYPED_TEST(ModelTest, NamesLeadBackToTheSameKindOfModel) { this->expectOfAll(expectNamesToLeadBack); }

}  // namespace
}  // namespace tartan_calib::camera
