#include "tartan_calib/target/target.h"

#include <gtest/gtest.h>

namespace tartan_calib::target {
namespace {

const AprilGrid kGrid{3, 4, 0.08, 0.25, "t36h11", 0, 2};  // gap 0.02 m

TEST(AprilGridTarget, hasTwoRowsAndColumnsOfCornersPerTag) {
  const Lattice lattice = cornerLattice(kGrid);
  EXPECT_EQ(lattice.rows, 6);
  EXPECT_EQ(lattice.cols, 8);
  EXPECT_EQ(numCorners(kGrid), 48);
  EXPECT_EQ(numTags(kGrid), 12);
}

TEST(AprilGridTarget, placesCornersByTagAndGap) {
  const auto points = cornerPoints(kGrid);
  ASSERT_EQ(points.size(), 48U);
  const double along_m[] = {0.0, 0.08, 0.10, 0.18, 0.20, 0.28, 0.30, 0.38};
  for (int row = 0; row < 6; ++row) {
    for (int col = 0; col < 8; ++col) {
      const Eigen::Vector3d expected(along_m[col], along_m[row], 0.0);
      EXPECT_LT((points[static_cast<std::size_t>(8 * row + col)] - expected).norm(), 1e-15) << row << " " << col;
    }
  }
}

TEST(AprilGridTarget, listsATagsCornersCounterClockwiseFromTheBottomLeft) {
  EXPECT_EQ(tagCornerIds(kGrid, 0), (std::vector<int>{0, 1, 9, 8}));
  EXPECT_EQ(tagCornerIds(kGrid, 3), (std::vector<int>{6, 7, 15, 14}));
  EXPECT_EQ(tagCornerIds(kGrid, 4), (std::vector<int>{16, 17, 25, 24}));  // first tag of the second row
  EXPECT_EQ(tagCornerIds(kGrid, 11), (std::vector<int>{38, 39, 47, 46}));
}

TEST(AprilGridTarget, givesEveryCornerToOneTag) {
  std::vector<int> times(48, 0);
  const auto points = cornerPoints(kGrid);
  for (int tag = 0; tag < numTags(kGrid); ++tag) {
    const auto ids = tagCornerIds(kGrid, tag);
    for (const int id : ids) {
      ++times[static_cast<std::size_t>(id)];
    }
    const Eigen::Vector3d diagonal = points[static_cast<std::size_t>(ids[2])] - points[static_cast<std::size_t>(ids[0])];
    EXPECT_LT((diagonal - Eigen::Vector3d(0.08, 0.08, 0.0)).norm(), 1e-15);
  }
  EXPECT_EQ(times, std::vector<int>(48, 1));
}

TEST(AprilGridTarget, numbersCornersFromTheFirstTagWhateverItsCode) {
  AprilGrid shifted = kGrid;
  shifted.code_offset = 100;
  EXPECT_EQ(tagCornerIds(shifted, 0), tagCornerIds(kGrid, 0));
}

TEST(CheckerboardTarget, runsWithXAlongTheRows) {
  const Checkerboard board{3, 4, 0.05, 0.02};
  const auto points = cornerPoints(board);
  ASSERT_EQ(points.size(), 12U);
  EXPECT_EQ(points[0], Eigen::Vector3d(0.0, 0.0, 0.0));
  EXPECT_EQ(points[1], Eigen::Vector3d(0.0, 0.02, 0.0));
  EXPECT_EQ(points[4], Eigen::Vector3d(0.05, 0.0, 0.0));
  EXPECT_LT((points[11] - Eigen::Vector3d(0.10, 0.06, 0.0)).norm(), 1e-15);
}

TEST(CircleGridTarget, runsWithXAlongTheRows) {
  const auto points = cornerPoints(CircleGrid{3, 4, 0.02, false});
  ASSERT_EQ(points.size(), 12U);
  EXPECT_EQ(points[1], Eigen::Vector3d(0.0, 0.02, 0.0));
  EXPECT_EQ(points[4], Eigen::Vector3d(0.02, 0.0, 0.0));
}

TEST(CircleGridTarget, shiftsOddRowsOfAnAsymmetricGridByHalfAColumn) {
  const auto points = cornerPoints(CircleGrid{4, 3, 0.02, true});
  ASSERT_EQ(points.size(), 12U);
  EXPECT_EQ(points[0], Eigen::Vector3d(0.0, 0.0, 0.0));
  EXPECT_EQ(points[1], Eigen::Vector3d(0.04, 0.0, 0.0));
  EXPECT_EQ(points[3], Eigen::Vector3d(0.02, 0.02, 0.0));
  EXPECT_EQ(points[6], Eigen::Vector3d(0.0, 0.04, 0.0));
}

}  // namespace
}  // namespace tartan_calib::target
