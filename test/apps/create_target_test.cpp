#include "create_target/create_target.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <opencv2/imgcodecs.hpp>

#include "common/program.h"
#include "create_target/drawing.h"
#include "create_target/sheet.h"
#include "support/expect_message.h"
#include "support/temporary_folder.h"
#include "tartan_calib/detection/target_detector.h"
#include "tartan_calib/io/target_yaml.h"

namespace tartan_calib::apps {
namespace {

using test_support::expectMessage;
using test_support::TemporaryFolder;

constexpr double kDpi = 200.0;
constexpr double kPixelsPerMm = kDpi / 25.4;

const std::vector<target::Target> kTargets = {
    target::AprilGrid{3, 4, 0.03, 0.3, "t36h11", 0, 2},
    target::AprilGrid{4, 3, 0.027, 0.25, "t36h11", 100, 2},
    target::AprilGrid{3, 3, 0.03, 0.3, "t36h11", 0, 1},
    target::AprilGrid{3, 4, 0.03, 0.3, "t25h9", 5, 2},
    target::Checkerboard{5, 8, 0.02, 0.025},
    target::Checkerboard{8, 5, 0.02, 0.02},
    target::CircleGrid{11, 4, 0.015, true},
};

/// The columns of the board run to the right; its rows up where it is an AprilGrid, else down.
Eigen::Vector2d rightAndDown(const target::Target& target, const Eigen::Vector3d& point_m) {
  constexpr double kMmPerM = 1e3;
  if (std::holds_alternative<target::AprilGrid>(target)) {
    return kMmPerM * Eigen::Vector2d(point_m.x(), -point_m.y());
  }
  const bool is_circles = std::holds_alternative<target::CircleGrid>(target);
  return kMmPerM * (is_circles ? Eigen::Vector2d(point_m.x(), point_m.y()) : Eigen::Vector2d(point_m.y(), point_m.x()));
}

/// Every corner is seen under its id where the board has it; only the place of the board on the page is free.
void expectBoard(const cv::Mat& gray, const target::Target& target) {
  constexpr double kTolerance_mm = 0.05;
  const std::vector<observation::Corner> corners = detection::TargetDetector(target).detect(gray).corners;
  ASSERT_EQ(static_cast<int>(corners.size()), target::numCorners(target));
  const std::vector<Eigen::Vector3d> points = target::cornerPoints(target);
  std::vector<Eigen::Vector2d> offsets_mm;
  Eigen::Vector2d mean_mm = Eigen::Vector2d::Zero();
  for (const observation::Corner& corner : corners) {
    const Eigen::Vector2d seen_mm = (corner.px + Eigen::Vector2d::Constant(0.5)) / kPixelsPerMm;
    offsets_mm.emplace_back(seen_mm - rightAndDown(target, points[static_cast<std::size_t>(corner.corner_id)]));
    mean_mm += offsets_mm.back() / static_cast<double>(corners.size());
  }
  for (const Eigen::Vector2d& offset_mm : offsets_mm) {
    EXPECT_LT((offset_mm - mean_mm).norm(), kTolerance_mm);
  }
}

/// The page of a PDF as any viewer shows it; empty where pdftoppm is not installed.
cv::Mat rasterized(const std::string& pdf) {
  const TemporaryFolder folder;
  std::ofstream(folder.file("page.pdf"), std::ios::binary) << pdf;
  const std::string command = "pdftoppm -r " + std::to_string(static_cast<int>(kDpi)) + " -gray -singlefile " +
                              folder.file("page.pdf") + " " + folder.file("page") + " 2> /dev/null";
  const bool is_done = std::system(command.c_str()) == 0;  // NOLINT(cert-env33-c): a fixed command
  return is_done ? cv::imread(folder.file("page.pgm"), cv::IMREAD_GRAYSCALE) : cv::Mat();
}

int longestDarkRun(const cv::Mat& row) {
  constexpr std::uint8_t kGray = 128;
  int longest = 0;
  int run = 0;
  for (int col = 0; col < row.cols; ++col) {
    run = row.at<std::uint8_t>(0, col) < kGray ? run + 1 : 0;
    longest = std::max(longest, run);
  }
  return longest;
}

std::string bytesOf(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

TEST(CreateTarget, DrawsAnImageInWhichEveryCornerIsWhereTheBoardHasIt) {
  for (const target::Target& target : kTargets) {
    const Sheet sheet = layOut(makeArtwork(target), "");
    SCOPED_TRACE(sheet.artwork.caption);
    expectBoard(imageOf(sheet, kPixelsPerMm), target);
  }
}

TEST(CreateTarget, PrintsAPageInWhichEveryCornerIsWhereTheBoardHasIt) {
  for (const target::Target& target : kTargets) {
    const Sheet sheet = layOut(makeArtwork(target), "");
    SCOPED_TRACE(sheet.artwork.caption);
    const cv::Mat page = rasterized(pdfOf(sheet));
    if (page.empty()) {
      GTEST_SKIP() << "pdftoppm (package poppler-utils) is not installed";
    }
    EXPECT_NEAR(page.cols, sheet.size_mm.x() * kPixelsPerMm, 1.0);
    EXPECT_NEAR(page.rows, sheet.size_mm.y() * kPixelsPerMm, 1.0);
    expectBoard(page, target);
  }
}

TEST(CreateTarget, PrintsARulerOfAHundredMillimetresBelowTheBoard) {
  const Sheet sheet = layOut(makeArtwork(kTargets.front()), "");
  for (const cv::Mat& page : {imageOf(sheet, kPixelsPerMm), rasterized(pdfOf(sheet))}) {
    if (page.empty()) {
      GTEST_SKIP() << "pdftoppm (package poppler-utils) is not installed";
    }
    const double board_end_mm = sheet.artwork_mm.y() + sheet.artwork.size_mm.y();
    int ruler_px = 0;
    for (int row = static_cast<int>(board_end_mm * kPixelsPerMm) + 1; row < page.rows; ++row) {
      ruler_px = std::max(ruler_px, longestDarkRun(page.row(row)));
    }
    constexpr double kLine_mm = 0.2;  // the width of the ticks at its ends
    EXPECT_NEAR(ruler_px / kPixelsPerMm, 100.0 + kLine_mm, 1.0 / kPixelsPerMm);
  }
}

TEST(CreateTarget, KeepsBoardAndRulerOffTheEdgesAndApart) {
  for (const target::Target& target : kTargets) {
    for (const char* paper : {"", "A2", "letter", "500x400"}) {
      const Sheet sheet = layOut(makeArtwork(target), paper);
      const Eigen::Vector2d end_mm = sheet.artwork_mm + sheet.artwork.size_mm;
      EXPECT_GE(sheet.artwork_mm.minCoeff(), 10.0 - 1e-9);
      EXPECT_LE(end_mm.x(), sheet.size_mm.x() - 10.0 + 1e-9);
      EXPECT_LE(end_mm.y(), sheet.ruler_mm.y() - 5.0);
      EXPECT_LE(sheet.ruler_mm.x() + kRulerLength_mm, sheet.size_mm.x() - 10.0 + 1e-9);
    }
  }
}

TEST(CreateTarget, TakesTheSmallestPaperThatFitsAndTurnsIt) {
  const auto size_mm = [](int rows, int cols, double square_m) {
    return layOut(makeArtwork(target::Checkerboard{rows, cols, square_m, square_m}), "").size_mm;
  };
  EXPECT_EQ(size_mm(7, 5, 0.025), Eigen::Vector2d(210, 297));
  EXPECT_EQ(size_mm(5, 7, 0.025), Eigen::Vector2d(297, 210));
  EXPECT_EQ(size_mm(5, 7, 0.04), Eigen::Vector2d(420, 297));
  EXPECT_EQ(size_mm(7, 9, 0.1), Eigen::Vector2d(1189, 841));
  EXPECT_EQ(size_mm(3, 4, 0.3), Eigen::Vector2d(1520, 1237)) << "no paper is so large: cut to the board";
}

TEST(CreateTarget, SaysTheSizesWhereTheBoardDoesNotFit) {
  const Artwork artwork = makeArtwork(target::Checkerboard{5, 7, 0.04, 0.04});
  expectMessage<InputError>([&] { layOut(artwork, "A4"); },
                            {"320.0 x 240.0 mm", "340.0 x 277.0 mm", "A4", "210.0 x 297.0 mm", "--page"});
  expectMessage<InputError>([&] { layOut(artwork, "339.9x277"); }, {"339.9 x 277.0 mm"});
  EXPECT_NO_THROW(layOut(artwork, "340x277"));
  expectMessage<UsageError>([&] { layOut(artwork, "A9"); }, {"A9", "A4", "letter"});
  expectMessage<InputError>([&] { imageOf(layOut(artwork, "A0"), 100.0); }, {"pixels", "--dpi"});
}

TEST(CreateTarget, WritesFilesThatBelongTogether) {
  const TemporaryFolder folder;
  for (const target::Target& target : kTargets) {
    createTarget({target, folder.file("board"), "A3", kDpi});
    EXPECT_EQ(io::targetText(io::loadTarget(folder.file("board.yaml")).target), io::targetText(target));
    expectBoard(cv::imread(folder.file("board.png"), cv::IMREAD_UNCHANGED), target);
    EXPECT_EQ(bytesOf(folder.file("board.pdf")), pdfOf(layOut(makeArtwork(target), "A3")));
  }
}

TEST(CreateTarget, WritesNoDateIntoThePdfAndTheScaleIntoThePng) {
  const Sheet sheet = layOut(makeArtwork(kTargets.front()), "A4");
  EXPECT_EQ(pdfOf(sheet).find("Date"), std::string::npos);
  const std::string png = pngOf(imageOf(sheet, 10.0), 10.0);
  const std::string ten_per_mm("pHYs\x00\x00\x27\x10\x00\x00\x27\x10\x01", 13);
  EXPECT_NE(png.find(ten_per_mm), std::string::npos);
}

TEST(CreateTarget, LeavesNothingBehindWhereItCannotFinish) {
  const TemporaryFolder folder;
  EXPECT_THROW(createTarget({target::AprilGrid{}, folder.file("board"), "A4", kDpi}), InputError);
  EXPECT_THROW(createTarget({target::AprilGrid{30, 30}, folder.file("board"), "", kDpi}), InputError);
  EXPECT_THROW(createTarget({kTargets.front(), folder.file("board"), "", 1e5}), InputError);
  EXPECT_THROW(createTarget({kTargets.front(), folder.file("nowhere/board"), "", kDpi}), InputError);
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(CreateTargetOptions, HaveKalibrsNamesAndDefaults) {
  const CreateTargetOptions defaults = *parseCreateTargetOptions({});
  EXPECT_EQ(defaults.base, "target");
  EXPECT_FALSE(defaults.dpi);
  EXPECT_EQ(io::targetText(defaults.target), io::targetText(target::AprilGrid{7, 6, 0.08, 0.3, "t36h11", 0, 2}));
  const CreateTargetOptions grid =
      *parseCreateTargetOptions({"a/b.pdf", "--type", "aprilgrid", "--nx=4", "--ny", "3", "--tsi", "1", "--tspace", "0.2",
                                 "--tf", "t36h10", "--tb", "1", "--first", "7"});
  EXPECT_EQ(grid.base, "a/b");
  EXPECT_EQ(io::targetText(grid.target), io::targetText(target::AprilGrid{3, 4, 1.0, 0.2, "t36h10", 7, 1}));
  const CreateTargetOptions board = *parseCreateTargetOptions(
      {"--type", "checkerboard", "--nx", "8", "--ny", "5", "--csx", "0.03", "--csy", "0.02", "--page", "A3", "--dpi", "72"});
  EXPECT_EQ(io::targetText(board.target), io::targetText(target::Checkerboard{5, 8, 0.02, 0.03}));
  EXPECT_EQ(board.page, "A3");
  EXPECT_EQ(board.dpi, 72.0);
  const CreateTargetOptions circles =
      *parseCreateTargetOptions({"--type", "circlegrid", "--nx", "4", "--ny", "11", "--spacing", "0.02", "--asym"});
  EXPECT_EQ(io::targetText(circles.target), io::targetText(target::CircleGrid{11, 4, 0.02, true}));
  EXPECT_FALSE(parseCreateTargetOptions({"--help"}));
}

TEST(CreateTargetOptions, TakeTheBoardOfAFile) {
  const TemporaryFolder folder;
  std::ofstream(folder.file("board.yaml")) << io::targetText(kTargets[1]);
  EXPECT_EQ(io::targetText(parseCreateTargetOptions({"--target", folder.file("board.yaml")})->target),
            io::targetText(kTargets[1]));
  EXPECT_THROW(parseCreateTargetOptions({"--target", folder.file("board.yaml"), "--nx", "6"}), UsageError);
  EXPECT_THROW(parseCreateTargetOptions({"--target", folder.file("board.yaml"), "--csx", "0.1"}), UsageError);
  EXPECT_THROW(parseCreateTargetOptions({"--target", folder.file("nowhere.yaml")}), InputError);
}

TEST(CreateTargetOptions, RefuseWhatMakesNoSense) {
  const std::vector<std::vector<std::string>> wrong = {
      {"--nx", "2"},
      {"--nx", "six"},
      {"--ny", "1001"},
      {"--tsize", "0"},
      {"--tsize", "nan"},
      {"--tspace", "inf"},
      {"--tborder", "3"},
      {"--first-id", "587"},
      {"--type", "square"},
      {"--csx", "0.1"},
      {"--dpi", "-1"},
      {"a", "b"},
      {"--type", "checkerboard", "--tsize", "0.1"},
      {"--no-such-flag"},
  };
  for (const std::vector<std::string>& arguments : wrong) {
    EXPECT_THROW(parseCreateTargetOptions(arguments), UsageError) << arguments.front() << " " << arguments.back();
  }
  expectMessage<InputError>([] { parseCreateTargetOptions({"--tfam", "t1h1"}); }, {"t1h1", "t36h11"});
}

}  // namespace
}  // namespace tartan_calib::apps
