#include <gtest/gtest.h>

#include <fstream>
#include <map>
#include <opencv2/imgcodecs.hpp>
#include <sstream>

#include "support/test_data.h"
#include "tartan_calib/detection/target_detector.h"

namespace tartan_calib::detection {
namespace {

using test_support::testData;

/// The board of every recorded AprilGrid.
const target::AprilGrid kGrid;

cv::Mat readGray8(const std::filesystem::path& file) {
  cv::Mat image = cv::imread(file.string(), cv::IMREAD_GRAYSCALE | cv::IMREAD_ANYDEPTH);
  if (image.depth() == CV_16U) {
    image.convertTo(image, CV_8U, 1.0 / 256.0);
  }
  return image;
}

std::vector<std::filesystem::path> sortedFiles(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

TEST(RecordedAprilGrid, isFoundThroughAFisheyeOf195Degrees) {
  TARTAN_CALIB_REQUIRE_TEST_DATA("tumvi_cam0");
  for (const auto& file : sortedFiles(testData("tumvi_cam0") / "images")) {
    const Detection detection = TargetDetector(kGrid).detect(readGray8(file));
    EXPECT_EQ(detection.counts.tags, 36) << file;
    EXPECT_EQ(detection.corners.size(), 144U) << file;
  }
}

TEST(RecordedAprilGrid, isFoundOnAMonitorInPicturesOfTwelveMegapixels) {
  TARTAN_CALIB_REQUIRE_TEST_DATA("detector_smoke");
  const TargetDetector detector(kGrid);
  EXPECT_EQ(detector.detect(readGray8(testData("detector_smoke") / "phone_full.jpg")).counts.tags, 36);
  EXPECT_EQ(detector.detect(readGray8(testData("detector_smoke") / "phone_partial.jpg")).counts.tags, 21);
}

TEST(RecordedAprilGrid, isFoundUpsideDownByAWebcam) {
  TARTAN_CALIB_REQUIRE_TEST_DATA("detector_smoke");
  const TargetDetector detector(kGrid);
  // The edge of the image cuts four tags of the second picture and three of the third.
  const std::map<std::string, int> num_visible = {
      {"webcam_1.jpg", 36}, {"webcam_2.jpg", 32}, {"webcam_3.jpg", 33}, {"webcam_4.jpg", 36}};
  for (const auto& [name, num_tags] : num_visible) {
    EXPECT_EQ(detector.detect(readGray8(testData("detector_smoke") / name)).counts.tags, num_tags) << name;
  }
}

std::map<int, Eigen::Vector2d> readCorners(const std::filesystem::path& csv) {
  std::ifstream file(csv);
  std::string line;
  std::getline(file, line);
  std::map<int, Eigen::Vector2d> corners;
  while (std::getline(file, line)) {
    std::vector<double> fields;
    std::stringstream stream(line);
    for (std::string field; std::getline(stream, field, ',');) {
      fields.push_back(std::stod(field));
    }
    const auto ids = target::tagCornerIds(kGrid, static_cast<int>(fields.at(10)));
    corners[ids.at(static_cast<std::size_t>(fields.at(11)))] = {fields.at(5), fields.at(6)};
  }
  return corners;
}

/// Corners under the reflective markers glued to the recorded board. The other detector extends the edges to them.
bool isUnderMarker(int corner_id) {
  static const std::vector<int> kMarked = {0, 5, 6, 11, 132, 143};
  return std::find(kMarked.begin(), kMarked.end(), corner_id) != kMarked.end();
}

TEST(RecordedAprilGrid, hasNoFewerCornersThanAnotherDetectorFound) {
  TARTAN_CALIB_REQUIRE_TEST_DATA("d435i_rgb");
  const TargetDetector detector(kGrid);
  int num_ours = 0;
  int num_theirs = 0;
  int num_missed = 0;
  int num_apart = 0;
  for (const auto& file : sortedFiles(testData("d435i_rgb") / "images")) {
    std::map<int, Eigen::Vector2d> ours;
    for (const observation::Corner& corner : detector.detect(readGray8(file)).corners) {
      ours[corner.corner_id] = corner.px;
    }
    const auto theirs = readCorners(testData("d435i_rgb") / "corners" / file.stem().concat(".csv"));
    num_ours += static_cast<int>(ours.size());
    num_theirs += static_cast<int>(theirs.size());
    for (const auto& [id, px] : theirs) {
      if (ours.count(id) == 0) {
        num_missed += isUnderMarker(id) ? 0 : 1;
      } else {
        num_apart += (ours[id] - px).norm() > 1.0 && !isUnderMarker(id) ? 1 : 0;
      }
    }
  }
  EXPECT_GE(num_ours, num_theirs);
  EXPECT_LE(num_missed, 10);  // of 4008
  EXPECT_LE(num_apart, 3);    // wrong ones of theirs
}

}  // namespace
}  // namespace tartan_calib::detection
