#include "calibrate_cameras/inputs.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <opencv2/imgcodecs.hpp>

#include "support/temporary_folder.h"
#include "tartan_calib/io/target_yaml.h"

namespace tartan_calib::apps {
namespace {

using Words = std::vector<std::string>;

/// What is told of an image and this board.
Words warningsOf(const target::Target& target, const Words& flags) {
  const test_support::TemporaryFolder folder;
  std::filesystem::create_directories(folder.file("images/cam0"));
  cv::imwrite(folder.file("images/cam0/1600000000000000000.png"), cv::Mat(48, 64, CV_8UC1, cv::Scalar(9)));
  std::ofstream(folder.file("board.yaml")) << io::targetText(target);
  Words words = {"--bag",    folder.file("images"), "--target", folder.file("board.yaml"),
                 "--topics", "/cam0/image_raw",     "--models", "ds-none"};
  words.insert(words.end(), flags.begin(), flags.end());
  Words warnings;
  openInputs(parseArguments(words), [&warnings](const std::string& text) { warnings.push_back(text); });
  return warnings;
}

TEST(Inputs, SayThatCirclesAreNotRefined) {
  const target::CircleGrid circles{7, 6, 0.03, false};
  const Words expected = {"--refinement has no effect: circles are not refined"};
  EXPECT_EQ(warningsOf(circles, {"--refinement", "adaptive"}), expected);
  EXPECT_EQ(warningsOf(circles, {"--refinement", "fixed"}), expected);
  EXPECT_EQ(warningsOf(circles, {}), Words());
  EXPECT_EQ(warningsOf(target::Checkerboard{6, 7, 0.03, 0.03}, {"--refinement", "fixed"}), Words());
}

}  // namespace
}  // namespace tartan_calib::apps
