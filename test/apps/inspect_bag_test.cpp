#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "inspect_bag/inspection.h"
#include "inspect_bag/report.h"
#include "simulate/simulate.h"
#include "support/temporary_folder.h"
#include "tartan_calib/io/target_yaml.h"

namespace tartan_calib::apps {
namespace {

using test_support::TemporaryFolder;

/// A board of squares turned by `angle_deg`, from grey 30 to 220.
cv::Mat squares(double angle_deg, const cv::Mat& blur_kernel) {
  constexpr int kSize = 400;
  constexpr int kFine = 4;  // drawn finer for smooth edges
  constexpr double kSquare_px = 40.0;
  cv::Mat fine(kFine * kSize, kFine * kSize, CV_8UC1);
  const double angle_rad = angle_deg * CV_PI / 180.0;
  for (int row = 0; row < fine.rows; ++row) {
    for (int col = 0; col < fine.cols; ++col) {
      const double x = (col * std::cos(angle_rad) + row * std::sin(angle_rad)) / kFine;
      const double y = (row * std::cos(angle_rad) - col * std::sin(angle_rad)) / kFine;
      const auto cell = static_cast<long>(std::floor(x / kSquare_px)) + static_cast<long>(std::floor(y / kSquare_px));
      fine.at<std::uint8_t>(row, col) = cell % 2 == 0 ? 30 : 220;
    }
  }
  cv::Mat gray;
  cv::resize(fine, gray, {kSize, kSize}, 0.0, 0.0, cv::INTER_AREA);
  cv::filter2D(gray, gray, -1, blur_kernel);
  cv::Mat noise(gray.size(), CV_16SC1);
  cv::RNG(1).fill(noise, cv::RNG::NORMAL, 0.0, 2.0);
  cv::add(gray, noise, gray, cv::noArray(), CV_8U);
  return gray;
}

cv::Mat defocus(double sigma_px) {
  const cv::Mat line = cv::getGaussianKernel(31, sigma_px);
  return line * line.t();
}

/// Motion over `length_px` along x.
cv::Mat motion(int length_px) { return cv::Mat(1, length_px, CV_64FC1, cv::Scalar(1.0 / length_px)); }

TEST(ImageQuality, MeasuresTheWidthOfBlurredEdges) {
  constexpr double kWidthOfSigma = 2.5066282746310002;  // contrast over slope of a Gaussian edge: sqrt(2 pi)
  for (const double angle_deg : {0.0, 17.0, 45.0}) {
    for (const double sigma_px : {1.5, 2.0, 3.0}) {
      const ImageQuality quality = qualityOf(squares(angle_deg, defocus(sigma_px)));
      ASSERT_TRUE(quality.edge_width_px);
      EXPECT_NEAR(*quality.edge_width_px, kWidthOfSigma * sigma_px, 0.2 * kWidthOfSigma * sigma_px) << angle_deg;
    }
  }
}

TEST(ImageQuality, SeesMotionInOneDirection) {
  for (const double angle_deg : {0.0, 17.0}) {
    const double sharp_px = qualityOf(squares(angle_deg, defocus(0.6))).edge_width_px.value_or(0.0);
    EXPECT_LT(sharp_px, 3.0);
    EXPECT_NEAR(qualityOf(squares(angle_deg, motion(9))).edge_width_px.value_or(0.0), 9.0, 2.0);
  }
}

TEST(ImageQuality, HasNoWidthWithoutEdges) {
  cv::Mat noise(300, 300, CV_8UC1);
  cv::RNG(1).fill(noise, cv::RNG::NORMAL, 100.0, 3.0);
  EXPECT_FALSE(qualityOf(noise).edge_width_px);
  EXPECT_FALSE(qualityOf(cv::Mat(10, 10, CV_8UC1, cv::Scalar(0))).edge_width_px);
}

TEST(ImageQuality, CountsLevels) {
  cv::Mat gray(100, 100, CV_8UC1, cv::Scalar(100));
  gray.rowRange(0, 10).setTo(255);
  gray.rowRange(10, 30).setTo(0);
  const ImageQuality quality = qualityOf(gray);
  EXPECT_NEAR(quality.mean_level, 95.5, 1e-9);
  EXPECT_NEAR(quality.saturated_ratio, 0.1, 1e-12);
  EXPECT_NEAR(quality.black_ratio, 0.2, 1e-12);
  EXPECT_EQ(quality.bright_level, 255.0);
}

TEST(Coverage, ShowsCornersWhereTheyAre) {
  pipeline::CameraCorners corners;
  corners.width = 320;
  corners.height = 240;
  observation::CameraView image;
  for (int i = 0; i < 10; ++i) {
    image.corners.push_back({i, {-0.5 + i, -0.5}});
  }
  image.corners.push_back({10, {319.5, 239.5}});
  corners.images = {image};
  const std::vector<std::string> picture = coveragePicture(corners);
  ASSERT_EQ(picture.size(), 12U);
  EXPECT_EQ(picture.front(), "#" + std::string(31, '.'));
  EXPECT_EQ(picture.back(), std::string(31, '.') + "+");
  const std::vector<std::string> empty = emptyThirds(corners);
  EXPECT_EQ(empty.size(), 7U);
  EXPECT_EQ(std::count(empty.begin(), empty.end(), "upper left"), 0);
  EXPECT_EQ(std::count(empty.begin(), empty.end(), "lower right"), 0);
}

/// Two cameras that lack nothing.
Inspection goodRig() {
  Inspection inspection;
  inspection.recording = "rig.bag";
  for (const char* topic : {"/cam0/image_raw", "/cam1/image_raw"}) {
    CameraInspection camera;
    camera.topic = topic;
    camera.type = "sensor_msgs/Image";
    camera.encodings = {"mono8"};
    camera.sizes = {{{640, 480}, 100}};
    camera.num_images = 100;
    camera.timing.period_s = 0.05;
    camera.timing.duration_s = 5.0;
    camera.timing.is_regular = true;
    camera.samples.assign(40, ImageQuality{100.0, 200.0, 0.01, 0.01, 2.0});
    inspection.cameras.push_back(camera);
  }
  inspection.synchronizations = {{1, Synchronization{0.001, 0.001, 0.001, 0.025, 1.0, -5.0}}};
  return inspection;
}

TEST(Warnings, AreNoneForAGoodRecording) { EXPECT_TRUE(inspectionWarnings(goodRig()).empty()); }

TEST(Warnings, NameTopicFaultAndRemedy) {
  struct Case {
    std::function<void(CameraInspection&, Synchronization&)> spoil;
    std::vector<std::string> words;
  };
  const std::vector<Case> cases = {
      {[](auto& c, auto&) { c.is_supported = false; }, {"mono8", "another topic"}},
      {[](auto& c, auto&) { c.num_unreadable = 3; }, {"3 ", "cannot be read"}},
      {[](auto& c, auto&) {
         c.num_unreadable = 3;
         c.refusal = "/cam1/image_raw: refused";
       },
       {"refused"}},
      {[](auto& c, auto&) { c.num_images = 5; }, {"only 5 images", "20"}},
      {[](auto& c, auto&) {
         c.sizes[{320, 240}] = 7;
       },
       {"640 x 480", "resolution"}},
      {[](auto& c, auto&) { c.timing.num_unstamped = 2; }, {"2 images", "header stamp"}},
      {[](auto& c, auto&) { c.timing.num_backwards = 2; }, {"2 stamps", "earlier"}},
      {[](auto& c, auto&) { c.timing.num_repeated = 2; }, {"2 images", "stamp of another"}},
      {[](auto& c, auto&) { c.timing.num_missing = 20; }, {"17 %", "--buffsize"}},
      {[](auto& c, auto&) { c.timing.median_delay_s = -3.0; }, {"-3.0 s", "clock"}},
      {[](auto& c, auto&) { std::for_each(c.samples.begin(), c.samples.end(), [](auto& s) { s.saturated_ratio = 0.2; }); },
       {"saturated", "exposure"}},
      {[](auto& c, auto&) { std::for_each(c.samples.begin(), c.samples.end(), [](auto& s) { s.bright_level = 60.0; }); },
       {"dark", "light"}},
      {[](auto& c, auto&) { std::for_each(c.samples.begin(), c.samples.end(), [](auto& s) { s.edge_width_px = 7.0; }); },
       {"focus"}},
      {[](auto& c, auto&) {
         std::for_each(c.samples.begin(), c.samples.begin() + 20, [](auto& s) { s.edge_width_px = 7.0; });
       },
       {"50 %", "motion"}},
      {[](auto&, auto& s) { s.p95_offset_s = 0.012; }, {"12.0 ms", "trigger"}},
      {[](auto&, auto& s) { s.within_half_ratio = 0.5; }, {"50 %", "partner"}},
      {[](auto&, auto& s) { s.apart_s = 60.0; }, {"60.0 s", "clocks"}},
  };
  for (const Case& each : cases) {
    Inspection inspection = goodRig();
    each.spoil(inspection.cameras[1], inspection.synchronizations[0].second);
    const std::vector<std::string> warnings = inspectionWarnings(inspection);
    ASSERT_EQ(warnings.size(), 1U) << each.words.front();
    EXPECT_EQ(warnings[0].rfind("/cam1/image_raw: ", 0), 0U) << warnings[0];
    for (const std::string& word : each.words) {
      EXPECT_NE(warnings[0].find(word), std::string::npos) << "'" << word << "' is not in: " << warnings[0];
    }
  }
}

TEST(Warnings, SayWhatIsWrongWithTheBoard) {
  Inspection inspection = goodRig();
  inspection.target = target::AprilGrid{};
  for (CameraInspection& camera : inspection.cameras) {  // a corner in every third of every image
    camera.corners.width = 640;
    camera.corners.height = 480;
    camera.corners.num_images = 40;
    camera.corners.counts.tags = 360;
    observation::CameraView image;
    for (const double y_px : {80.0, 240.0, 400.0}) {
      for (const double x_px : {100.0, 300.0, 500.0}) {
        image.corners.push_back({static_cast<int>(image.corners.size()), {x_px, y_px}});
      }
    }
    camera.corners.images.assign(40, image);
  }
  EXPECT_TRUE(inspectionWarnings(inspection).empty());
  struct Case {
    std::function<void(pipeline::CameraCorners&)> spoil;
    std::string words;
  };
  const std::vector<Case> cases = {
      {[](auto& c) { c.images.clear(); }, "no board was seen"},
      {[](auto& c) { c.images.resize(10); }, "only 10 of 40"},
      {[](auto& c) {
         for (auto& image : c.images) {
           image.corners.pop_back();
         }
       },
       "no corners in the lower right of"},
      {[](auto& c) { c.counts.mirrored_tags = 3; }, "mirrored"},
      {[](auto& c) { c.counts.other_border_tags = 500; }, "tagBorder: 1"},
      {[](auto& c) {
         c.images.clear();
         c.counts.other_sizes[{5, 4}] = 30;
       },
       "5 rows and 4 columns"},
      {[](auto& c) {
         c.counts.other_sizes[{5, 4}] = 90;
       },
       "5 rows and 4 columns"},
  };
  for (const Case& each : cases) {
    Inspection spoilt = inspection;
    each.spoil(spoilt.cameras[1].corners);
    const std::vector<std::string> warnings = inspectionWarnings(spoilt);
    ASSERT_EQ(warnings.size(), 1U) << each.words;
    EXPECT_EQ(warnings[0].rfind("/cam1/image_raw: ", 0), 0U) << warnings[0];
    EXPECT_NE(warnings[0].find(each.words), std::string::npos) << warnings[0];
  }
}

TEST(Text, NamesTheBoardThatIsThereInsteadOfTheTargets) {
  Inspection inspection = goodRig();
  inspection.target = target::AprilGrid{};
  pipeline::CameraCorners& corners = inspection.cameras[0].corners;
  corners.num_images = 40;
  EXPECT_NE(inspectionText(inspection).find("not seen in any of 40 images\n"), std::string::npos);
  corners.counts.other_sizes[{5, 4}] = 30;
  EXPECT_NE(inspectionText(inspection).find("not seen in any of 40 images: 30 images show 5 rows and 4 columns of tags"),
            std::string::npos)
      << inspectionText(inspection);
}

TEST(Text, TellsTheBrightestPartOfTheImages) {
  Inspection inspection = goodRig();
  EXPECT_NE(inspectionText(inspection).find("brightest 1 % from 200 on;"), std::string::npos);
  for (ImageQuality& sample : inspection.cameras[0].samples) {
    sample.bright_level = 255.0;
  }
  EXPECT_NE(inspectionText(inspection).find("brightest 1 % at 255;"), std::string::npos);
}

TEST(Command, NamesTheUsableTopics) {
  Inspection inspection = goodRig();
  const std::string start = "rosrun tartan_calib calibrate_cameras --bag rig.bag --target ";
  EXPECT_EQ(calibrationCommand(inspection, "a b.yaml"),
            start + "'a b.yaml' --topics /cam0/image_raw /cam1/image_raw --models ds-none ds-none");
  inspection.cameras[0].left_out = "no board was seen";
  EXPECT_EQ(calibrationCommand(inspection, ""), start + "board.yaml --topics /cam1/image_raw --models ds-none");
  inspection.cameras[1].left_out = "no board was seen";
  EXPECT_EQ(calibrationCommand(inspection, ""), "");
}

TEST(Command, WidensTheToleranceUpToHalfAPeriodOnly) {
  Inspection inspection = goodRig();
  Synchronization& sync = inspection.synchronizations[0].second;
  sync.max_offset_s = 0.0205;
  EXPECT_NE(calibrationCommand(inspection, "").find(" --approx-sync 0.022"), std::string::npos);
  sync.max_offset_s = 0.0249;
  EXPECT_NE(calibrationCommand(inspection, "").find(" --approx-sync 0.025"), std::string::npos);
}

TEST(Command, ThinsOutLongRecordings) {
  Inspection inspection = goodRig();
  for (CameraInspection& camera : inspection.cameras) {
    camera.num_images = 3000;
    camera.timing.duration_s = 150.0;
  }
  EXPECT_NE(calibrationCommand(inspection, "").find(" --bag-freq 2.11"), std::string::npos) << "9.5 periods, not 10";
  inspection.cameras[0].num_images = inspection.cameras[1].num_images = 400;
  EXPECT_EQ(calibrationCommand(inspection, "").find("--bag-freq"), std::string::npos);
}

TEST(Inspection, OfBagAndFolderFindsTheBoard) {
  const TemporaryFolder folder;
  const std::vector<std::string> scene = {"--lens",  "pinhole70", "--resolution", "320x256",
                                          "--views", "8",         "--cameras",    "2"};
  for (const std::string output : {"--output-bag", "--output-dir"}) {
    const std::string recording = folder.file(output == "--output-bag" ? "run.bag" : "run");
    std::vector<std::string> arguments = {output, recording};
    arguments.insert(arguments.end(), scene.begin(), scene.end());
    const std::string base = simulate(*parseSimulateOptions(arguments)).base;
    const Inspection inspection = inspect(recording, io::loadTarget(base + "-target.yaml").target);
    ASSERT_EQ(inspection.cameras.size(), 2U);
    ASSERT_EQ(inspection.synchronizations.size(), 1U);
    EXPECT_EQ(inspection.synchronizations[0].second.max_offset_s, 0.0);
    for (const CameraInspection& camera : inspection.cameras) {
      EXPECT_TRUE(camera.isUsable()) << camera.left_out;
      EXPECT_EQ(camera.num_images, 8U);
      EXPECT_EQ(usualSize(camera), ImageSize(320, 256));
      EXPECT_EQ(camera.samples.size(), 8U);
      EXPECT_GE(camera.corners.images.size(), 7U);
      EXPECT_NEAR(camera.timing.period_s, 0.25, 1e-9);
    }
    const std::string text = inspectionText(inspection);
    EXPECT_NE(text.find("/cam1/image_raw"), std::string::npos);
    EXPECT_NE(text.find("320 x 256"), std::string::npos);
  }
}

TEST(Inspection, LeavesOutACameraThatSeesNoBoard) {
  const TemporaryFolder folder;
  simulate(*parseSimulateOptions(
      {"--output-bag", folder.file("run.bag"), "--lens", "pinhole70", "--resolution", "320x256", "--views", "3"}));
  const Inspection inspection = inspect(folder.file("run.bag"), target::Checkerboard{17, 23, 0.02, 0.02});
  EXPECT_EQ(inspection.cameras.front().left_out, "no board was seen");
  EXPECT_EQ(calibrationCommand(inspection, ""), "");
}

}  // namespace
}  // namespace tartan_calib::apps
