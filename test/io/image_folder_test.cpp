#include "tartan_calib/io/image_folder.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <opencv2/imgcodecs.hpp>

#include "tartan_calib/error.h"

namespace tartan_calib::io {
namespace {

namespace fs = std::filesystem;

/// A folder that is removed with the test, and images of one grey value in it.
class ImageFolder : public ::testing::Test {
 protected:
  ImageFolder() : folder(fs::temp_directory_path() / ("image_foldertest." + std::to_string(::getpid()))) {
    fs::create_directories(folder);
    options.notice = [this](const std::string& text) { notices.push_back(text); };
  }
  ~ImageFolder() override { fs::remove_all(folder); }

  void write(const std::string& name, int value = 100, int type = CV_8UC1) {
    const fs::path path = folder / name;
    fs::create_directories(path.parent_path());
    cv::imwrite(path.string(), cv::Mat(6, 8, type, cv::Scalar::all(value)));
  }

  std::vector<std::int64_t> stamps(const std::string& topic) {
    std::vector<std::int64_t> stamps_ns;
    const auto source = openImageFolder(folder.string(), {topic}, options).front().open();
    while (auto image = source()) {
      stamps_ns.push_back(image->stamp_ns);
    }
    return stamps_ns;
  }

  std::string errorOf(const std::string& topic) {
    try {
      openImageFolder(folder.string(), {topic}, options);
    } catch (const InputError& error) {
      return error.what();
    }
    return "no error";
  }

  fs::path folder;
  RecordingOptions options;
  std::vector<std::string> notices;
};

TEST_F(ImageFolder, HasATopicForEverySubfolderWithImagesInOrderOfCameras) {
  write("cam10/1.png");
  write("cam2/1.jpg");
  write("cam0/1.pgm");
  fs::create_directories(folder / "notes");
  std::ofstream(folder / "imu0.csv") << "1,0,0,0,0,0,0\n";
  EXPECT_EQ(imageFolderTopics(folder.string()),
            (std::vector<std::string>{"/cam0/image_raw", "/cam2/image_raw", "/cam10/image_raw"}));
}

TEST_F(ImageFolder, OrdersImagesByStampNotByName) {
  for (const char* name : {"1000.png", "999.jpg", "30.bmp", "1606153907495166540.PNG"}) {
    write(std::string("cam0/") + name);
  }
  EXPECT_EQ(stamps("/cam0/image_raw"), (std::vector<std::int64_t>{30, 999, 1000, 1606153907495166540}));
}

TEST_F(ImageFolder, UnderstandsTheNameOfACameraForItsTopic) {
  write("cam0/1.png");
  for (const char* name : {"cam0", "/cam0", "cam0/image_raw", "/cam0/image_raw"}) {
    EXPECT_EQ(openImageFolder(folder.string(), {name}, options).front().topic, "/cam0/image_raw");
  }
}

TEST_F(ImageFolder, LoadsImagesAsEightBitGrey) {
  write("cam0/1.png", 100, CV_8UC3);
  write("cam0/2.png", 100 * 256, CV_16UC1);
  const auto source = openImageFolder(folder.string(), {"/cam0/image_raw"}, options).front().open();
  const cv::Mat from_color = source()->load();
  EXPECT_EQ(from_color.type(), CV_8UC1);
  EXPECT_EQ(from_color.size(), cv::Size(8, 6));
  EXPECT_EQ(from_color.at<std::uint8_t>(3, 3), 100);
  EXPECT_EQ(source()->load().type(), CV_8UC1);
}

TEST_F(ImageFolder, TellsOnceHowSixteenBitImagesAreReduced) {
  write("cam0/1.png", 100, CV_16UC1);
  write("cam0/2.png", 100, CV_16UC1);
  stamps("/cam0/image_raw");
  ASSERT_EQ(notices.size(), 1U);
  EXPECT_NE(notices.front().find("16-bit"), std::string::npos);
}

TEST_F(ImageFolder, LeavesOutFilesThatAreNotNamedByAStampAndSaysSo) {
  write("cam0/1.png");
  write("cam0/left_2.png");
  write("cam0/99999999999999999999.png");
  EXPECT_EQ(stamps("/cam0/image_raw").size(), 1U);
  ASSERT_EQ(notices.size(), 1U);
  EXPECT_NE(notices.front().find("2 images"), std::string::npos) << notices.front();
}

TEST_F(ImageFolder, LeavesOutFoldersThatAreNamedLikeImages) {
  write("cam0/1.png");
  fs::create_directories(folder / "cam0/2.png");
  fs::create_directories(folder / "cam1/3.png");
  EXPECT_EQ(stamps("/cam0/image_raw"), std::vector<std::int64_t>{1});
  EXPECT_EQ(imageFolderTopics(folder.string()).size(), 1U);
}

TEST_F(ImageFolder, NamesWhatIsMissing) {
  EXPECT_NE(errorOf("/cam0/image_raw").find("no subfolder"), std::string::npos);
  write("cam0/left_2.png");
  EXPECT_NE(errorOf("/cam0/image_raw").find("left_2.png"), std::string::npos);
  EXPECT_NE(errorOf("/cam1/image_raw").find("image topics: /cam0/image_raw"), std::string::npos);
}

TEST_F(ImageFolder, ReportsABrokenImageWhereItIsLoaded) {
  write("cam0/1.png");
  write("cam0/2.png");
  fs::resize_file(folder / "cam0/1.png", 40);
  const auto source = openImageFolder(folder.string(), {"/cam0/image_raw"}, options).front().open();
  try {
    source()->load();
    FAIL() << "a truncated file was loaded";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("1.png"), std::string::npos) << error.what();
  }
  EXPECT_NO_THROW(source()->load());
}

}  // namespace
}  // namespace tartan_calib::io
