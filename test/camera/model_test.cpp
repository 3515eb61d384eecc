#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <variant>
#include <vector>

#include "tartan_calib/camera/camera.h"

namespace tartan_calib::camera {
namespace {

/// Parameter sets per model: mild ones, those of real lenses, and ones near the ends of the parameters' range.
template <class ModelType>
std::vector<Eigen::VectorXd> parameterSets();

Eigen::VectorXd values(std::initializer_list<double> list) {
  return Eigen::Map<const Eigen::VectorXd>(list.begin(), static_cast<Eigen::Index>(list.size()));
}

template <>
std::vector<Eigen::VectorXd> parameterSets<PinholeNone>() {
  return {values({400.0, 410.0, 319.5, 239.5})};
}
template <>
std::vector<Eigen::VectorXd> parameterSets<PinholeRadtan>() {
  return {values({400.0, 400.0, 319.5, 239.5, 0.0, 0.0, 0.0, 0.0}),
          values({400.0, 410.0, 320.0, 240.0, -0.2, 0.13, 0.0005, 0.0005}),
          values({458.654, 457.296, 367.215, 248.375, -0.28340811, 0.07395907, 0.00019359, 1.76187e-5}),
          values({500.0, 500.0, 320.0, 240.0, 0.3, 0.1, -0.002, 0.003})};
}
template <>
std::vector<Eigen::VectorXd> parameterSets<PinholeEqui>() {
  return {values({300.0, 300.0, 511.5, 383.5, 0.0, 0.0, 0.0, 0.0}),
          values({380.0, 381.0, 512.0, 384.0, -0.00185, 0.01901, -0.02422, 0.01429}),
          values({190.0, 190.5, 254.9, 256.9, 0.0034, 0.0007, -0.0020, 0.0002}),
          values({350.0, 350.0, 640.0, 480.0, -0.05, -0.01, 0.002, -0.0005})};
}
template <>
std::vector<Eigen::VectorXd> parameterSets<PinholeFov>() {
  return {values({400.0, 400.0, 320.0, 240.0, 1.0}), values({300.0, 310.0, 320.0, 240.0, 0.3}),
          values({300.0, 300.0, 320.0, 240.0, 1.5})};
}
template <>
std::vector<Eigen::VectorXd> parameterSets<OmniNone>() {
  return {values({0.0, 400.0, 400.0, 320.0, 240.0}), values({0.9, 600.0, 610.0, 320.0, 240.0}),
          values({1.0, 700.0, 700.0, 320.0, 240.0}), values({1.8, 800.0, 805.0, 320.0, 240.0})};
}
template <>
std::vector<Eigen::VectorXd> parameterSets<OmniRadtan>() {
  return {values({0.9, 600.0, 610.0, 320.0, 240.0, -0.1, 0.02, 0.001, -0.001}),
          values({1.826, 793.26, 791.0, 322.3, 236.8, -0.04435, 0.19035, -1.1e-05, 3.4e-05})};
}
template <>
std::vector<Eigen::VectorXd> parameterSets<Eucm>() {
  return {values({0.0, 1.0, 400.0, 400.0, 320.0, 240.0}), values({0.63, 1.04, 380.0, 385.0, 640.0, 512.0}),
          values({0.45, 1.3, 300.0, 300.0, 640.0, 512.0}), values({0.6, 0.5, 300.0, 300.0, 640.0, 512.0})};
}
template <>
std::vector<Eigen::VectorXd> parameterSets<DoubleSphere>() {
  return {values({0.0, 0.0, 400.0, 400.0, 320.0, 240.0}), values({-0.18, 0.59, 313.0, 314.0, 640.0, 512.0}),
          values({-0.27, 0.57, 364.84, 364.86, 640.0, 512.0}), values({0.5, 0.3, 500.0, 500.0, 640.0, 512.0}),
          values({-0.21105, 0.56984, 158.27, 157.97, 318.6, 242.2})};
}

template <class ModelType>
ModelType modelOf(const Eigen::VectorXd& parameters) {
  return ModelType(typename ModelType::Parameters(parameters));
}

Eigen::Vector3d direction(double polar_rad, double azimuth_rad) {
  return {std::sin(polar_rad) * std::cos(azimuth_rad), std::sin(polar_rad) * std::sin(azimuth_rad), std::cos(polar_rad)};
}

/// Largest polar angle along an azimuth up to which every direction projects, to 1e-4 rad.
template <class ModelType>
double edgeOfValidity(const ModelType& model, double azimuth_rad) {
  constexpr double kStep_rad = 1e-4;
  Eigen::Vector2d px;
  double polar = 0.0;
  while (polar < M_PI && model.project(direction(polar + kStep_rad, azimuth_rad), px)) {
    polar += kStep_rad;
  }
  return polar;
}

constexpr double kAzimuths_rad[] = {0.0, 0.7, 2.1, M_PI, 4.0, 5.5};

template <class ModelType>
class ModelTest : public testing::Test {};

template <class Variant>
struct KindsOf;
template <class... Kinds>
struct KindsOf<std::variant<Kinds...>> {
  using Types = testing::Types<Kinds...>;
};

TYPED_TEST_SUITE(ModelTest, KindsOf<CameraModel>::Types);

TYPED_TEST(ModelTest, RayToPixelToRayHoldsUpToTheEdgeOfValidity) {
  for (const Eigen::VectorXd& parameters : parameterSets<TypeParam>()) {
    const TypeParam model = modelOf<TypeParam>(parameters);
    for (const double azimuth : kAzimuths_rad) {
      const double edge = edgeOfValidity(model, azimuth);
      ASSERT_GT(edge, 0.5) << parameters.transpose();
      for (const double share : {0.0, 1e-9, 1e-4, 0.1, 0.5, 0.9, 0.99}) {
        const Eigen::Vector3d ray = direction(share * edge, azimuth);
        Eigen::Vector2d px;
        Eigen::Vector3d back;
        ASSERT_TRUE(model.project(3.0 * ray, px));
        ASSERT_TRUE(model.unproject(px, back)) << parameters.transpose() << " polar " << share * edge;
        // 1e-8 rad is 1e-5 px; near a fold the image stands still and the ray follows less precisely.
        EXPECT_LT((back - ray).norm(), share < 0.95 ? 1e-8 : 1e-6) << parameters.transpose() << " polar " << share * edge;
      }
    }
  }
}

TYPED_TEST(ModelTest, PixelToRayToPixelReturns) {
  for (const Eigen::VectorXd& parameters : parameterSets<TypeParam>()) {
    const TypeParam model = modelOf<TypeParam>(parameters);
    const Eigen::Vector2d centre = parameters.template segment<2>(TypeParam::kFocalIndex + 2);
    int rays = 0;
    for (double u = -300.0; u <= 300.0; u += 50.0) {
      for (double v = -300.0; v <= 300.0; v += 50.0) {
        const Eigen::Vector2d px = centre + Eigen::Vector2d(u, v);
        Eigen::Vector3d ray;
        Eigen::Vector2d back;
        if (!model.unproject(px, ray)) {
          continue;
        }
        ++rays;
        EXPECT_NEAR(ray.norm(), 1.0, 1e-12);
        if (model.project(ray, back)) {
          EXPECT_LT((back - px).norm(), 1e-6) << parameters.transpose() << " at " << px.transpose();
        } else {
          // Only at the very rim may a pixel have a ray that lies in the margin of the validity test.
          const double polar = std::atan2(ray.head<2>().norm(), ray.z());
          EXPECT_GT(polar + 2e-3, edgeOfValidity(model, std::atan2(ray.y(), ray.x()))) << parameters.transpose();
        }
      }
    }
    EXPECT_GT(rays, 40) << parameters.transpose();
  }
}

TYPED_TEST(ModelTest, ImageRadiusGrowsWithTheAngleUpToTheEdge) {
  for (const Eigen::VectorXd& parameters : parameterSets<TypeParam>()) {
    const TypeParam model = modelOf<TypeParam>(parameters);
    const Eigen::Vector2d centre = parameters.template segment<2>(TypeParam::kFocalIndex + 2);
    const double edge = edgeOfValidity(model, 0.3);
    double last = -1.0;
    for (double polar = 0.0; polar < edge; polar += 0.01) {
      Eigen::Vector2d px;
      ASSERT_TRUE(model.project(direction(polar, 0.3), px));
      const double radius = (px - centre).norm();
      EXPECT_GT(radius, last) << parameters.transpose() << " polar " << polar;
      last = radius;
    }
  }
}

TYPED_TEST(ModelTest, ProjectionDoesNotDependOnTheDistance) {
  for (const Eigen::VectorXd& parameters : parameterSets<TypeParam>()) {
    const TypeParam model = modelOf<TypeParam>(parameters);
    const Eigen::Vector3d p = direction(0.6, 1.0);
    Eigen::Vector2d near;
    Eigen::Vector2d far;
    ASSERT_TRUE(model.project(0.01 * p, near));
    ASSERT_TRUE(model.project(1000.0 * p, far));
    EXPECT_LT((near - far).norm(), 1e-9);
  }
}

TYPED_TEST(ModelTest, PointJacobianEqualsCentralDifferences) {
  constexpr double kStep = 1e-6;
  for (const Eigen::VectorXd& parameters : parameterSets<TypeParam>()) {
    const TypeParam model = modelOf<TypeParam>(parameters);
    for (const double azimuth : kAzimuths_rad) {
      const double edge = edgeOfValidity(model, azimuth);
      for (const double share : {0.0, 1e-8, 1e-3, 0.3, 0.7, 0.9}) {
        const Eigen::Vector3d p = 0.7 * direction(share * edge, azimuth);
        Eigen::Vector2d px;
        Matrix23d J;
        ASSERT_TRUE(model.project(p, px, &J));
        Matrix23d numeric;
        for (int i = 0; i < 3; ++i) {
          Eigen::Vector2d plus;
          Eigen::Vector2d minus;
          const Eigen::Vector3d step = kStep * Eigen::Vector3d::Unit(i);
          ASSERT_TRUE(model.project(p + step, plus));
          ASSERT_TRUE(model.project(p - step, minus));
          numeric.col(i) = (plus - minus) / (2.0 * kStep);
        }
        // The difference quotient carries about 1e-10 px / 1e-6 of rounding and a relative 1e-6 of curvature.
        EXPECT_LT((J - numeric).norm(), 1e-5 * (10.0 + numeric.norm())) << parameters.transpose() << "\nanalytic\n"
                                                                        << J << "\nnumeric\n"
                                                                        << numeric << "\npolar " << share * edge;
      }
    }
  }
}

TYPED_TEST(ModelTest, ParameterJacobianEqualsCentralDifferences) {
  for (const Eigen::VectorXd& parameters : parameterSets<TypeParam>()) {
    for (const double share : {0.0, 0.3, 0.7, 0.9}) {
      const TypeParam model = modelOf<TypeParam>(parameters);
      const Eigen::Vector3d p = 0.7 * direction(share * edgeOfValidity(model, 2.1), 2.1);
      Eigen::Vector2d px;
      typename TypeParam::ParameterJacobian J;
      ASSERT_TRUE(model.project(p, px, nullptr, &J));
      for (int i = 0; i < TypeParam::kNumParameters; ++i) {
        const double step = 1e-6 * std::max(1.0, std::abs(parameters(i)));
        Eigen::VectorXd plus = parameters;
        Eigen::VectorXd minus = parameters;
        plus(i) += step;
        minus(i) -= step;
        Eigen::Vector2d px_plus;
        Eigen::Vector2d px_minus;
        ASSERT_TRUE(modelOf<TypeParam>(plus).project(p, px_plus));
        ASSERT_TRUE(modelOf<TypeParam>(minus).project(p, px_minus));
        const Eigen::Vector2d numeric = (px_plus - px_minus) / (2.0 * step);
        EXPECT_LT((J.col(i) - numeric).norm(), 1e-5 * (10.0 + numeric.norm()))
            << parameters.transpose() << " parameter " << i << " analytic " << J.col(i).transpose() << " numeric "
            << numeric.transpose();
      }
    }
  }
}

TYPED_TEST(ModelTest, PointsWithoutAnImageAreReportedAndLeaveThePixelAlone) {
  for (const Eigen::VectorXd& parameters : parameterSets<TypeParam>()) {
    const TypeParam model = modelOf<TypeParam>(parameters);
    const double nan = std::numeric_limits<double>::quiet_NaN();
    for (const Eigen::Vector3d& p :
         {Eigen::Vector3d(0.0, 0.0, -1.0), Eigen::Vector3d(0.0, 0.0, 0.0), Eigen::Vector3d(nan, 0.0, 1.0)}) {
      Eigen::Vector2d px(-7.0, -8.0);
      EXPECT_FALSE(model.project(p, px)) << parameters.transpose() << " p " << p.transpose();
      EXPECT_EQ(px, Eigen::Vector2d(-7.0, -8.0));
    }
  }
}

TYPED_TEST(ModelTest, StartHasTheAskedScaleInTheCentre) {
  const TypeParam model(TypeParam::start(250.0, Eigen::Vector2d(100.0, 80.0)));
  Eigen::Vector2d axis;
  Eigen::Vector2d beside;
  ASSERT_TRUE(model.project(Eigen::Vector3d::UnitZ(), axis));
  ASSERT_TRUE(model.project(direction(1e-4, 0.0), beside));
  EXPECT_EQ(axis, Eigen::Vector2d(100.0, 80.0));
  EXPECT_NEAR((beside - axis).norm() / 1e-4, 250.0, 1e-3);
}

TYPED_TEST(ModelTest, BoundsContainTheStartAndTheSetsOfRealLenses) {
  for (const Eigen::VectorXd& parameters : parameterSets<TypeParam>()) {
    EXPECT_TRUE((parameters.array() >= TypeParam::lowerBound().array()).all()) << parameters.transpose();
    EXPECT_TRUE((parameters.array() <= TypeParam::upperBound().array()).all()) << parameters.transpose();
  }
}

TYPED_TEST(ModelTest, NamesLeadBackToTheSameKindOfModel) {
  const CameraModel model = modelOf<TypeParam>(parameterSets<TypeParam>().front());
  EXPECT_EQ(modelByName(modelName(model)).index(), model.index());
  EXPECT_EQ(modelByKalibrNames(kalibrModel(model), kalibrDistortion(model)).index(), model.index());
  EXPECT_EQ(parameters(withParameters(model, parameterSets<TypeParam>().back())), parameterSets<TypeParam>().back());
  EXPECT_EQ(numParameters(model), parameterSets<TypeParam>().front().size());
}

}  // namespace
}  // namespace tartan_calib::camera
