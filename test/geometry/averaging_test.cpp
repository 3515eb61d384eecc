#include "tartan_calib/geometry/averaging.h"

#include <gtest/gtest.h>

#include <random>

#include "tartan_calib/error.h"

namespace tartan_calib::geometry {
namespace {

class AveragingTest : public testing::Test {
 protected:
  Eigen::Vector3d vector(double scale) {
    std::normal_distribution<double> normal(0.0, scale);
    return {normal(random_), normal(random_), normal(random_)};
  }

  /// Noisy copies of a transform, the last `num_wrong` replaced by anything.
  std::vector<Rigid3> noisy(const Rigid3& T, int num_good, int num_wrong) {
    std::vector<Rigid3> transforms;
    for (int k = 0; k < num_good; ++k) {
      transforms.push_back(Rigid3(expRotation(vector(kNoise)) * T.rotation, T.translation + vector(kNoise)));
    }
    for (int k = 0; k < num_wrong; ++k) {
      transforms.push_back(Rigid3(expRotation(vector(2.0)), vector(10.0)));
    }
    return transforms;
  }

  static constexpr double kNoise = 0.01;

 private:
  std::mt19937 random_{1};
};

double sumOfDistances(const std::vector<Eigen::Vector3d>& points, const Eigen::Vector3d& from) {
  double sum = 0.0;
  for (const Eigen::Vector3d& point : points) {
    sum += (point - from).norm();
  }
  return sum;
}

double sumOfAngles(const std::vector<Eigen::Quaterniond>& rotations, const Eigen::Quaterniond& from) {
  double sum = 0.0;
  for (const Eigen::Quaterniond& R : rotations) {
    sum += R.angularDistance(from);
  }
  return sum;
}

TEST_F(AveragingTest, aThirdOfWrongInputsMovesTheMedianLittle) {
  const Rigid3 truth(expRotation({0.4, -1.0, 0.3}), {0.1, -0.2, 0.05});
  const Rigid3 median = medianRigid(noisy(truth, 100, 50));
  EXPECT_LT(median.rotation.angularDistance(truth.rotation), kNoise);
  EXPECT_LT((median.translation - truth.translation).norm(), kNoise);
}

TEST_F(AveragingTest, theMedianOfManyIsBetterThanTheBestOfThem) {
  const Rigid3 truth(expRotation({0.4, -1.0, 0.3}), {0.1, -0.2, 0.05});
  const Rigid3 median = medianRigid(noisy(truth, 1000, 0));
  // Noise of the mean would be kNoise * sqrt(3 / 1000).
  EXPECT_LT(median.rotation.angularDistance(truth.rotation), 0.12 * kNoise);
  EXPECT_LT((median.translation - truth.translation).norm(), 0.12 * kNoise);
}

TEST_F(AveragingTest, theMedianHasTheLeastSumOfDistances) {
  std::vector<Eigen::Vector3d> points;
  std::vector<Eigen::Quaterniond> rotations;
  for (const Rigid3& T : noisy(Rigid3(), 15, 4)) {
    points.push_back(T.translation);
    rotations.push_back(T.rotation);
  }
  const Eigen::Vector3d point = medianPoint(points);
  const Eigen::Quaterniond rotation = medianRotation(rotations);
  for (int k = 0; k < 3; ++k) {
    for (const double step : {-1e-4, 1e-4}) {
      const Eigen::Vector3d moved = step * Eigen::Vector3d::Unit(k);
      EXPECT_LT(sumOfDistances(points, point), sumOfDistances(points, point + moved));
      EXPECT_LT(sumOfAngles(rotations, rotation), sumOfAngles(rotations, expRotation(moved) * rotation));
    }
  }
}

TEST_F(AveragingTest, theMedianOfATriangleIsInsideOfIt) {
  const std::vector<Eigen::Vector3d> corners = {{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}};
  EXPECT_LT((medianPoint(corners) - Eigen::Vector3d::Constant(1.0 / 3.0)).norm(), 1e-9);
}

TEST_F(AveragingTest, theMedianIsAnInputWhereMoreThanHalfAreEqual) {
  const Eigen::Vector3d point(0.1, 0.2, 0.3);
  const Eigen::Quaterniond rotation = expRotation(point);
  EXPECT_LT((medianPoint({point, {5.0, 0.0, 0.0}, point, {0.0, 7.0, 0.0}, point}) - point).norm(), 1e-12);
  EXPECT_LT(medianRotation({rotation, expRotation({2.0, 0.0, 0.0}), rotation}).angularDistance(rotation), 1e-7);
  EXPECT_EQ(medianPoint({point}), point);
}

TEST_F(AveragingTest, theMedianTurnsWithItsInputs) {
  const Eigen::Quaterniond turn = expRotation({1.0, 2.0, -0.5});
  std::vector<Eigen::Quaterniond> rotations;
  std::vector<Eigen::Quaterniond> turned;
  for (const Rigid3& T : noisy(Rigid3(), 9, 2)) {
    rotations.push_back(T.rotation);
    turned.push_back(turn * T.rotation);
  }
  EXPECT_LT((turn * medianRotation(rotations)).angularDistance(medianRotation(turned)), 1e-7);
}

TEST_F(AveragingTest, signsOfQuaternionsDoNotMatter) {
  std::vector<Eigen::Quaterniond> rotations;
  std::vector<Eigen::Quaterniond> flipped;
  for (const Rigid3& T : noisy(Rigid3(expRotation({0.0, 3.0, 0.0}), Eigen::Vector3d::Zero()), 8, 0)) {
    rotations.push_back(T.rotation);
    flipped.push_back(flipped.size() % 2 == 0 ? Eigen::Quaterniond(-T.rotation.coeffs()) : T.rotation);
  }
  EXPECT_LT(medianRotation(rotations).angularDistance(medianRotation(flipped)), 1e-7);
}

TEST_F(AveragingTest, nothingHasNoMedian) {
  EXPECT_THROW(medianPoint({}), Error);
  EXPECT_THROW(medianRotation({}), Error);
}

}  // namespace
}  // namespace tartan_calib::geometry
