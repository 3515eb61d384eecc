#include "tartan_calib/report/report_data.h"

#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>  // which reads JSON

#include <filesystem>

#include "moving_scene.h"
#include "support/temporary_folder.h"

namespace tartan_calib::report {
namespace {

/// The data of a rig with a text that JSON must escape.
class ReportDataTest : public testing::Test {
 protected:
  void SetUp() override {
    result_ = solved(movingScene(0.0));
    result_.warnings = {"a \"quoted\"\\path\twith a tab"};
    analysis_ = analysed(result_);
    verdict_ = judge(result_, analysis_);
    writeReportData(folder_.path().string(), {"rig.bag", result_, analysis_, verdict_, {}});
    data_ = YAML::LoadFile(folder_.file("data.json"));
  }

  std::size_t numRows(const YAML::Node& table) const {
    const auto num_bytes = std::filesystem::file_size(folder_.file(table["file"].as<std::string>()));
    return num_bytes / sizeof(double) / table["columns"].size();
  }

  test_support::TemporaryFolder folder_;
  pipeline::CalibrationResult result_;
  Analysis analysis_;
  Verdict verdict_;
  YAML::Node data_;
};

TEST_F(ReportDataTest, NamesVerdictAndWarningsAsTheyAre) {
  EXPECT_EQ(data_["verdict"]["grade"].as<std::string>(), gradeName(verdict_.grade));
  EXPECT_EQ(data_["warnings"][0].as<std::string>(), result_.warnings[0]);
  EXPECT_EQ(data_["recording"].as<std::string>(), "rig.bag");
}

TEST_F(ReportDataTest, HasARowForEveryCornerAndEverySampleOfTheMap) {
  ASSERT_EQ(data_["cameras"].size(), 2U);
  for (std::size_t i = 0; i < 2; ++i) {
    const YAML::Node camera = data_["cameras"][i];
    EXPECT_EQ(numRows(camera["found"]), analysis_.cameras[i].corners.found.size());
    EXPECT_EQ(numRows(camera["missed"]), analysis_.cameras[i].corners.missed.size());
    EXPECT_EQ(numRows(camera["map"]), analysis_.cameras[i].map.samples.size());
    EXPECT_GT(numRows(camera["curve"]), 100U);
  }
  EXPECT_EQ(data_["views"].size(), result_.solution.views.size());
}

}  // namespace
}  // namespace tartan_calib::report
