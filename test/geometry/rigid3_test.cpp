#include "tartan_calib/geometry/rigid3.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <random>
#include <vector>

namespace tartan_calib::geometry {
namespace {

constexpr double kPi = 3.14159265358979323846;
/// Where closed forms lose digits or change branch: zero, below and above the switch to series, and next to pi.
const std::vector<double> kAngles_rad = {0.0, 1e-12, 1e-8, 0.99e-4, 1.01e-4, 1e-2, 1.0, 3.0, kPi - 1e-6};

class Rigid3Test : public testing::Test {
 protected:
  Eigen::Vector3d vector(double scale = 1.0) {
    std::normal_distribution<double> normal(0.0, scale);
    return {normal(random_), normal(random_), normal(random_)};
  }
  Eigen::Vector3d axis() { return vector().normalized(); }
  Rigid3 rigid() { return {expRotation(vector()), vector(2.0)}; }
  Vector6d twist(double angle_rad) {
    Vector6d xi;
    xi << vector(), angle_rad * axis();
    return xi;
  }

 private:
  std::mt19937 random_{1};
};

void expectSame(const Rigid3& a, const Rigid3& b, double tolerance) {
  EXPECT_LT((a.matrix() - b.matrix()).cwiseAbs().maxCoeff(), tolerance) << a.matrix() << "\n\n" << b.matrix();
}

/// Sum of the exponential series after halving the argument often enough.
Eigen::Matrix4d matrixExponential(Eigen::Matrix4d m) {
  constexpr int kHalvings = 10;
  m /= std::pow(2.0, kHalvings);
  Eigen::Matrix4d term = Eigen::Matrix4d::Identity();
  Eigen::Matrix4d sum = term;
  for (int k = 1; k < 20; ++k) {
    term = term * m / k;
    sum += term;
  }
  for (int k = 0; k < kHalvings; ++k) {
    sum = sum * sum;
  }
  return sum;
}

TEST_F(Rigid3Test, isAGroup) {
  for (int trial = 0; trial < 20; ++trial) {
    const Rigid3 a = rigid();
    const Rigid3 b = rigid();
    const Rigid3 c = rigid();
    expectSame((a * b) * c, a * (b * c), 1e-13);
    expectSame(a * Rigid3(), a, 1e-15);
    expectSame(Rigid3() * a, a, 1e-15);
    expectSame(a * a.inverse(), Rigid3(), 1e-14);
    expectSame(a.inverse() * a, Rigid3(), 1e-14);
  }
}

TEST_F(Rigid3Test, actsOnPointsAsItsMatrix) {
  const Rigid3 a = rigid();
  const Rigid3 b = rigid();
  const Eigen::Vector3d p = vector();
  EXPECT_LT(((a * p) - (a.matrix() * p.homogeneous()).head<3>()).norm(), 1e-14);
  EXPECT_LT(((a * b) * p - a * (b * p)).norm(), 1e-14);
  EXPECT_LT((a.matrix() * b.matrix() - (a * b).matrix()).norm(), 1e-14);
}

TEST_F(Rigid3Test, keepsItsRotationNormalisedThroughLongProducts) {
  Rigid3 product;
  const Rigid3 step = rigid();
  for (int k = 0; k < 100000; ++k) {
    product = step * product;
  }
  EXPECT_NEAR(product.rotation.norm(), 1.0, 1e-15);
}

TEST_F(Rigid3Test, expRotationTurnsByTheAngleAboutTheAxis) {
  for (const double angle_rad : kAngles_rad) {
    const Eigen::Vector3d n = axis();
    const Eigen::Matrix3d expected = Eigen::AngleAxisd(angle_rad, n).toRotationMatrix();
    EXPECT_LT((expRotation(angle_rad * n).toRotationMatrix() - expected).norm(), 1e-15) << angle_rad;
  }
}

TEST_F(Rigid3Test, logUndoesExp) {
  for (const double angle_rad : kAngles_rad) {
    const Eigen::Vector3d phi = angle_rad * axis();
    EXPECT_LT((logRotation(expRotation(phi)) - phi).norm(), 1e-15 + 4e-16 * angle_rad) << angle_rad;
    const Vector6d xi = twist(angle_rad);
    EXPECT_LT((logRigid(expRigid(xi)) - xi).norm(), 1e-14 * (1.0 + xi.norm())) << angle_rad;
  }
}

TEST_F(Rigid3Test, logIsRelativelyExactForTinyRotations) {
  const Eigen::Vector3d phi = 1e-8 * axis();
  EXPECT_LT((logRotation(expRotation(phi)) - phi).norm(), 1e-15 * phi.norm());
}

TEST_F(Rigid3Test, logTakesBothSignsOfAQuaternionForTheSameRotation) {
  const Eigen::Quaterniond q = expRotation(2.0 * axis());
  EXPECT_LT((logRotation(q) - logRotation(Eigen::Quaterniond(-q.coeffs()))).norm(), 1e-15);
}

TEST_F(Rigid3Test, expRigidIsTheMatrixExponential) {
  for (const double angle_rad : kAngles_rad) {
    const Vector6d xi = twist(angle_rad);
    Eigen::Matrix4d generator = Eigen::Matrix4d::Zero();
    generator.topLeftCorner<3, 3>() = hat(xi.tail<3>());
    generator.topRightCorner<3, 1>() = xi.head<3>();
    EXPECT_LT((expRigid(xi).matrix() - matrixExponential(generator)).norm(), 2e-12) << angle_rad;
  }
}

TEST_F(Rigid3Test, leftJacobianEqualsCentralDifferences) {
  constexpr double kStep = 1e-6;
  for (const double angle_rad : kAngles_rad) {
    const Eigen::Vector3d phi = angle_rad * axis();
    const Eigen::Quaterniond back = expRotation(phi).conjugate();
    Eigen::Matrix3d numeric;
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3d d = kStep * Eigen::Vector3d::Unit(k);
      numeric.col(k) = (logRotation(expRotation(phi + d) * back) - logRotation(expRotation(phi - d) * back)) / (2 * kStep);
    }
    EXPECT_LT((leftJacobian(phi) - numeric).cwiseAbs().maxCoeff(), 1e-9) << angle_rad;
  }
}

TEST_F(Rigid3Test, perturbationsActFromTheLeft) {
  constexpr double kStep = 1e-6;
  const Rigid3 T = rigid();
  const Eigen::Vector3d p = vector();
  Eigen::Matrix<double, 3, 6> expected;
  expected << Eigen::Matrix3d::Identity(), -hat(T * p);
  for (int k = 0; k < 6; ++k) {
    const Vector6d d = kStep * Vector6d::Unit(k);
    const Eigen::Vector3d numeric = (expRigid(d) * T * p - expRigid(-d) * T * p) / (2 * kStep);
    EXPECT_LT((numeric - expected.col(k)).norm(), 1e-8) << k;
  }
}

TEST_F(Rigid3Test, adjointMovesAPerturbationToTheOtherSide) {
  for (const double angle_rad : kAngles_rad) {
    const Rigid3 T = rigid();
    const Vector6d xi = twist(angle_rad);
    expectSame(expRigid(adjoint(T) * xi), T * expRigid(xi) * T.inverse(), 1e-12);
  }
}

TEST_F(Rigid3Test, hatIsTheCrossProduct) {
  const Eigen::Vector3d a = vector();
  const Eigen::Vector3d b = vector();
  EXPECT_LT((hat(a) * b - a.cross(b)).norm(), 1e-15);
}

TEST_F(Rigid3Test, rotationBetweenTurnsOneDirectionIntoTheOtherTheShortestWay) {
  for (const double angle_rad : {0.0, 1e-9, 1e-4, 1.0, 3.0, M_PI - 1e-6, M_PI - 1e-12, M_PI}) {
    const Eigen::Vector3d from = vector();
    const Eigen::Vector3d axis = from.cross(vector()).normalized();
    const Eigen::Vector3d to = 3.0 * (expRotation(angle_rad * axis) * from);
    const Eigen::Quaterniond R = rotationBetween(from, to);
    EXPECT_LT((R * from.normalized() - to.normalized()).norm(), 1e-8) << angle_rad;
    EXPECT_NEAR(logRotation(R).norm(), angle_rad, 1e-7);
  }
}

TEST_F(Rigid3Test, isReadFromAMatrixRoundedByAFile) {
  const Rigid3 T = rigid();
  const Eigen::Matrix4d rounded = (T.matrix() * 1e6).array().round() / 1e6;
  const Rigid3 read = rigidFromMatrix(rounded);
  expectSame(read, T, 2e-6);
  const Eigen::Matrix3d R = read.rotation.toRotationMatrix();
  EXPECT_LT((R * R.transpose() - Eigen::Matrix3d::Identity()).norm(), 1e-15);
}

TEST_F(Rigid3Test, isTheNearestRotationToAMatrixThatMirrors) {
  const Rigid3 T = rigid();
  const Eigen::Matrix3d basis = rigid().rotation.toRotationMatrix();
  Eigen::Matrix4d mirrored = T.matrix();
  mirrored.topLeftCorner<3, 3>() *= basis * Eigen::Vector3d(1.0, 1.0, -0.01).asDiagonal() * basis.transpose();
  expectSame(rigidFromMatrix(mirrored), T, 1e-14);
}

}  // namespace
}  // namespace tartan_calib::geometry
