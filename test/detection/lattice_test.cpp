#include "tartan_calib/detection/lattice.h"

#include <gtest/gtest.h>

#include <map>
#include <opencv2/imgproc.hpp>

#include "support/board_scene.h"

namespace tartan_calib::detection {
namespace {

using simulation::TrueCorner;
using test_support::BoardScene;
using test_support::kDegree;

const target::Checkerboard kBoard = {7, 9, 0.06, 0.06};

/// Lattice coordinates (row, column) of the board's corners that a lattice holds, by corner id.
std::map<int, Eigen::Vector2i> placesById(const SaddleLattice& lattice, const std::vector<Saddle>& saddles,
                                          const std::vector<TrueCorner>& truth) {
  std::map<int, Eigen::Vector2i> places;
  for (const LatticeNode& node : lattice.nodes()) {
    for (const TrueCorner& corner : truth) {
      if ((corner.px - saddles[static_cast<std::size_t>(node.saddle_index)].px).norm() < 1.0) {
        places[corner.corner_id] = {node.row, node.column};
      }
    }
  }
  return places;
}

/// True if steps on the board are steps in the lattice: all places follow from the first by one turn.
bool isConsistent(const std::map<int, Eigen::Vector2i>& places) {
  for (int turn = 0; turn < 4; ++turn) {
    Eigen::Matrix2i R;
    R << (turn % 2 == 0 ? 1 - turn : 0), (turn % 2 == 1 ? turn - 2 : 0), (turn % 2 == 1 ? 2 - turn : 0),
        (turn % 2 == 0 ? 1 - turn : 0);
    const auto board_place = [&R](int id) {
      return Eigen::Vector2i(R * Eigen::Vector2i(id / kBoard.cols, id % kBoard.cols));
    };
    const Eigen::Vector2i shift = places.begin()->second - board_place(places.begin()->first);
    bool fits = true;
    for (const auto& [id, place] : places) {
      fits = fits && place == board_place(id) + shift;
    }
    if (fits) {
      return true;
    }
  }
  return false;
}

/// Half of a circular fisheye image is the board, its squares bent.
BoardScene closeUp(std::vector<TrueCorner>& truth) {
  BoardScene scene(test_support::fisheyeCamera(700, 700, 240.0));
  truth = scene.add(kBoard, {0.16, 10.0 * kDegree, 0.5, 15.0 * kDegree, -10.0 * kDegree, 0.3});
  return scene;
}

TEST(GrowLattices, followsABoardThroughStrongDistortion) {
  std::vector<TrueCorner> truth;
  const cv::Mat image = closeUp(truth).expose(0.7, 2.0);
  const auto saddles = findSaddles(image);
  const auto lattices = growLattices(image, saddles);
  ASSERT_FALSE(lattices.empty());
  const auto places = placesById(lattices.front(), saddles, truth);
  EXPECT_EQ(lattices.front().nodes().size(), places.size());
  EXPECT_EQ(static_cast<int>(places.size()), target::numCorners(kBoard));
  EXPECT_TRUE(isConsistent(places));
}

TEST(GrowLattices, doesNotJumpOverAHiddenCorner) {
  std::vector<TrueCorner> truth;
  BoardScene scene = closeUp(truth);
  const auto hidden = truth.at(3U * 9U + 4U);
  cv::circle(scene.grey(), {static_cast<int>(hidden.px.x()) + 6, static_cast<int>(hidden.px.y()) + 4}, 28, cv::Scalar(180.0),
             cv::FILLED);
  const cv::Mat image = scene.expose(0.7, 2.0);
  const auto saddles = findSaddles(image);
  const auto places = placesById(growLattices(image, saddles).front(), saddles, truth);
  EXPECT_EQ(places.count(hidden.corner_id), 0U);
  EXPECT_EQ(static_cast<int>(places.size()), target::numCorners(kBoard) - 1);
  EXPECT_TRUE(isConsistent(places));
}

TEST(GrowLattices, knowsDarkFacesAndNeverMirrors) {
  std::vector<TrueCorner> truth;
  const cv::Mat image = closeUp(truth).expose(0.7, 2.0);
  const auto saddles = findSaddles(image);
  const SaddleLattice lattice = growLattices(image, saddles).front();
  for (int row = 0; row + 1 < lattice.numRows(); ++row) {
    for (int column = 0; column + 1 < lattice.numColumns(); ++column) {
      const auto px = [&](int c, int r) { return saddles.at(static_cast<std::size_t>(lattice.saddleIndexAt(c, r))).px; };
      const Eigen::Vector2d along_column = px(column + 1, row) - px(column, row);
      const Eigen::Vector2d along_row = px(column, row + 1) - px(column, row);
      EXPECT_GT(along_column.x() * along_row.y() - along_column.y() * along_row.x(), 0.0);
      const Eigen::Vector2d middle =
          0.25 * (px(column, row) + px(column + 1, row) + px(column, row + 1) + px(column + 1, row + 1));
      const bool is_dark = image.at<uchar>(static_cast<int>(middle.y()), static_cast<int>(middle.x())) < 110;
      EXPECT_EQ(lattice.isDarkFace(column, row), is_dark);
    }
  }
}

TEST(GrowLattices, findsNothingInAnEmptyImage) {
  const cv::Mat image(100, 100, CV_8UC1, cv::Scalar(128));
  EXPECT_TRUE(growLattices(image, findSaddles(image)).empty());
}

TEST(SaddleLatticeOf, hasNothingOutside) {
  const SaddleLattice lattice({{0, 0, 4}, {1, 0, 5}, {1, 1, 6}}, 0);
  EXPECT_EQ(lattice.numColumns(), 2);
  EXPECT_EQ(lattice.numRows(), 2);
  EXPECT_EQ(lattice.saddleIndexAt(1, 1), 6);
  EXPECT_EQ(lattice.saddleIndexAt(0, 1), -1);
  EXPECT_EQ(lattice.saddleIndexAt(2, 0), -1);
  EXPECT_EQ(lattice.saddleIndexAt(0, -1), -1);
}

}  // namespace
}  // namespace tartan_calib::detection
