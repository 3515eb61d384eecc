#include "tartan_calib/report/report_data.h"

#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>  // which reads JSON

#include <filesystem>

#include "moving_scene.h"
#include "support/temporary_folder.h"
#include "tartan_calib/pipeline/warnings.h"

namespace tartan_calib::report {
namespace {

/// The data of a rig with a text that JSON must escape.
class ReportDataTest : public testing::Test {
 protected:
  void SetUp() override {
    result = solved(movingScene(0.0));
    result.warnings = {"stated by the verdict", "a \"quoted\"\\path\twith a tab"};
    analysis = analysed(result);
    verdict = judge(result, analysis);
    verdict.reasons.push_back({Grade::kUsable, "stated by the verdict"});
    writeReportData(folder.path().string(), {"rig.bag", result, analysis, verdict, {}});
    data = YAML::LoadFile(folder.file("data.json"));
  }

  std::size_t numRows(const YAML::Node& table) const {
    const auto num_bytes = std::filesystem::file_size(folder.file(table["file"].as<std::string>()));
    return num_bytes / sizeof(double) / table["columns"].size();
  }

  test_support::TemporaryFolder folder;
  pipeline::CalibrationResult result;
  Analysis analysis;
  Verdict verdict;
  YAML::Node data;
};

TEST_F(ReportDataTest, NamesVerdictAndWarningsAsTheyAre) {
  EXPECT_EQ(data["verdict"]["grade"].as<std::string>(), gradeName(verdict.grade));
  ASSERT_EQ(data["warnings"].size(), 1U);  // that of the verdict is not said twice
  EXPECT_EQ(data["warnings"][0].as<std::string>(), result.warnings[1]);
  EXPECT_EQ(data["recording"].as<std::string>(), "rig.bag");
}

TEST_F(ReportDataTest, NotesDoNotRepeatReasonsInOtherWords) {
  calibration::CameraStatistics& few = result.cameras[0].statistics;
  few.num_views = 5;
  few.rms_px = 2.0;
  result.solution.counts[0].outliers = result.solution.counts[0].used;
  result.warnings = pipeline::resultWarnings(result);
  ASSERT_EQ(result.warnings.size(), 3U);
  result.warnings.emplace_back("cam1: 9 of 90 corners were rejected (9 outliers)");  // of the other camera
  writeReportData(folder.path().string(), {"rig.bag", result, analysis, judge(result, analysis), {}});
  const YAML::Node notes = YAML::LoadFile(folder.file("data.json"))["warnings"];
  ASSERT_EQ(notes.size(), 1U);
  EXPECT_EQ(notes[0].as<std::string>(), result.warnings.back());
}

TEST_F(ReportDataTest, HasARowForEveryCornerAndEverySampleOfTheMap) {
  ASSERT_EQ(data["cameras"].size(), 2U);
  for (std::size_t i = 0; i < 2; ++i) {
    const YAML::Node camera = data["cameras"][i];
    EXPECT_EQ(numRows(camera["found"]), analysis.cameras[i].corners.found.size());
    EXPECT_EQ(numRows(camera["missed"]), analysis.cameras[i].corners.missed.size());
    EXPECT_EQ(numRows(camera["map"]), analysis.cameras[i].map.samples.size());
    EXPECT_GT(numRows(camera["curve"]), 100U);
  }
  EXPECT_EQ(data["views"].size(), result.solution.views.size());
}

}  // namespace
}  // namespace tartan_calib::report
