#include "tartan_calib/camera/pupil_shift.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "tartan_calib/camera/camera.h"

namespace tartan_calib::camera {
namespace {

constexpr double kStep = 1e-6;

/// From the axis to well behind the lens, near and far.
std::vector<Eigen::Vector3d> points() {
  return {{0.0, 0.0, 0.2}, {1e-9, 0.0, 0.2}, {0.03, -0.02, 0.1}, {0.1, 0.2, 0.01}, {-0.1, 0.05, -0.04}, {3.0, 1.0, 2.0}};
}

PupilShift pupil() { return {{0.0011, 0.0004}}; }

TEST(PupilShift, JacobiansAreThoseOfDifferences) {
  for (const Eigen::Vector3d& p : points()) {
    Eigen::Matrix3d J_p;
    PupilShift::Jacobian J_coefficients;
    pupil().apply(p, &J_p, &J_coefficients);
    for (int i = 0; i < 3; ++i) {
      const Eigen::Vector3d step = kStep * Eigen::Vector3d::Unit(i);
      const Eigen::Vector3d numeric = (pupil().apply(p + step) - pupil().apply(p - step)) / (2.0 * kStep);
      EXPECT_LT((J_p.col(i) - numeric).norm(), 1e-7) << p.transpose();
    }
    for (int i = 0; i < PupilShift::kNumParameters; ++i) {
      PupilShift more = pupil();
      PupilShift less = pupil();
      more.coefficients_m(i) += kStep;
      less.coefficients_m(i) -= kStep;
      const Eigen::Vector3d numeric = (more.apply(p) - less.apply(p)) / (2.0 * kStep);
      EXPECT_LT((J_coefficients.col(i) - numeric).norm(), 1e-9) << p.transpose();
    }
  }
}

TEST(PupilShift, RaysOfOnePolarAngleMeetInOnePointOfTheAxis) {
  constexpr double kAngle_rad = 1.2;
  const Eigen::Vector3d near = 0.1 * Eigen::Vector3d(std::sin(kAngle_rad), 0.0, std::cos(kAngle_rad));
  EXPECT_NEAR((near - pupil().apply(near)).z(), pupil().at_m(kAngle_rad), 1e-15);
  EXPECT_NEAR(pupil().at_m(kAngle_rad), 0.0011 * 1.44 + 0.0004 * 1.44 * 1.44, 1e-12);
}

TEST(PupilShift, VanishesForFarPoints) {
  Camera camera{DoubleSphere({-0.2, 0.6, 300.0, 300.0, 320.0, 240.0}), 640, 480, pupil()};
  const Eigen::Vector3d direction(0.8, -0.3, 0.4);
  const Eigen::Vector2d central = *project(camera.model, direction);
  EXPECT_GT((*project(camera, 0.1 * direction) - central).norm(), 1.0);
  EXPECT_LT((*project(camera, 1e4 * direction) - central).norm(), 1e-3);
}

TEST(PupilShift, ProjectionThroughItHasTheJacobianOfDifferences) {
  const Camera camera{DoubleSphere({-0.2, 0.6, 300.0, 300.0, 320.0, 240.0}), 640, 480, pupil()};
  for (const Eigen::Vector3d& p : points()) {
    Matrix23d J;
    ASSERT_TRUE(project(camera, p, &J));
    for (int i = 0; i < 3; ++i) {
      const Eigen::Vector3d step = 1e-2 * kStep * Eigen::Vector3d::Unit(i);
      const auto above = project(camera, p + step);
      const auto below = project(camera, p - step);
      ASSERT_TRUE(above && below);
      EXPECT_LT((J.col(i) - (*above - *below) / (2.0 * step.norm())).norm(), 1e-3 * J.norm()) << p.transpose();
    }
  }
}

}  // namespace
}  // namespace tartan_calib::camera
