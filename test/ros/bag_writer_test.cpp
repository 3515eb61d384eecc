#include <gtest/gtest.h>

#include <filesystem>

#include "ros/bag_file.h"

namespace tartan_calib::ros {
namespace {

TEST(BagWriter, LeavesNothingBehindUnlessClosed) {
  const BagFile bag;
  { BagWriter(bag.path()).writeImage(kTopic, kStart, grayRamp()); }
  EXPECT_FALSE(std::filesystem::exists(bag.path()));
  EXPECT_FALSE(std::filesystem::exists(bag.path() + ".partial"));
}

TEST(BagWriter, StoresPartsOfLargerImages) {
  const BagFile bag;
  BagWriter writer(bag.path());
  writer.writeImage(kTopic, kStart, grayRamp()(cv::Rect(3, 2, 10, 8)));
  writer.close();
  const cv::Mat gray = readAll(bag.path()).front().load();
  EXPECT_EQ(largestDifference(gray, grayRamp()(cv::Rect(3, 2, 10, 8))), 0.0);
}

TEST(BagWriter, NamesTheBagThatItCannotWrite) {
  EXPECT_NE(errorOf([] { BagWriter("/nowhere/a.bag"); }).find("/nowhere/a.bag"), std::string::npos);
}

}  // namespace
}  // namespace tartan_calib::ros
