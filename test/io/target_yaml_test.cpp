#include "tartan_calib/io/target_yaml.h"

#include <gtest/gtest.h>

#include <map>

#include "support/expect_message.h"
#include "support/temporary_folder.h"
#include "tartan_calib/error.h"
#include "tartan_calib/io/atomic_file.h"

namespace tartan_calib::io {
namespace {

using test_support::expectMessage;
using test_support::TemporaryFolder;

using Keys = std::map<std::string, std::string>;

const Keys kAprilGrid = {
    {"target_type", "'aprilgrid'"}, {"tagCols", "6"}, {"tagRows", "5"}, {"tagSize", "0.088"}, {"tagSpacing", "0.3"}};
const Keys kCheckerboard = {{"target_type", "'checkerboard'"},
                            {"targetCols", "10"},
                            {"targetRows", "7"},
                            {"rowSpacingMeters", "0.06"},
                            {"colSpacingMeters", "0.05"}};
const Keys kCircleGrid = {{"target_type", "circlegrid"},
                          {"targetCols", "6"},
                          {"targetRows", "7"},
                          {"spacingMeters", "0.02"},
                          {"asymmetricGrid", "True"}};

std::string yaml(const Keys& keys) {
  std::string text;
  for (const auto& [key, value] : keys) {
    text += key + ": " + value + "  # a comment\n";
  }
  return text;
}

Keys with(Keys keys, const std::string& key, const std::string& value) {
  keys[key] = value;
  return keys;
}

LoadedTarget parse(const Keys& keys) { return parseTarget(yaml(keys), "board.yaml"); }

TEST(TargetYaml, ReadsEveryFieldOfAnAprilGrid) {
  const LoadedTarget loaded = parse(kAprilGrid);
  const auto& grid = std::get<target::AprilGrid>(loaded.target);
  EXPECT_EQ(grid.tag_cols, 6);
  EXPECT_EQ(grid.tag_rows, 5);
  EXPECT_EQ(grid.tag_size_m, 0.088);
  EXPECT_EQ(grid.tag_spacing_ratio, 0.3);
  EXPECT_EQ(grid.family, "t36h11");
  EXPECT_EQ(grid.code_offset, 0);
  EXPECT_EQ(grid.border_cells, 2);
  EXPECT_TRUE(loaded.warnings.empty());
}

TEST(TargetYaml, ReadsTheOptionalKeysOfAnAprilGrid) {
  Keys keys = with(kAprilGrid, "tagFamily", "t36h11");
  keys = with(with(keys, "codeOffset", "100"), "tagBorder", "1");
  const LoadedTarget loaded = parse(keys);
  const auto& grid = std::get<target::AprilGrid>(loaded.target);
  EXPECT_EQ(grid.code_offset, 100);
  EXPECT_EQ(grid.border_cells, 1);
  EXPECT_TRUE(loaded.warnings.empty());
}

TEST(TargetYaml, ReadsEveryFieldOfACheckerboard) {
  const auto board = std::get<target::Checkerboard>(parse(kCheckerboard).target);
  EXPECT_EQ(board.cols, 10);
  EXPECT_EQ(board.rows, 7);
  EXPECT_EQ(board.row_spacing_m, 0.06);
  EXPECT_EQ(board.col_spacing_m, 0.05);
}

TEST(TargetYaml, ReadsEveryFieldOfACircleGrid) {
  const auto grid = std::get<target::CircleGrid>(parse(kCircleGrid).target);
  EXPECT_EQ(grid.cols, 6);
  EXPECT_EQ(grid.rows, 7);
  EXPECT_EQ(grid.spacing_m, 0.02);
  EXPECT_TRUE(grid.asymmetric);
}

TEST(TargetYaml, AWholeNumberIsASizeToo) {
  const auto grid = std::get<target::AprilGrid>(parse(with(kAprilGrid, "tagSize", "1")).target);
  EXPECT_EQ(grid.tag_size_m, 1.0);
}

TEST(TargetYaml, AnUnknownKeyIsAWarningThatNamesIt) {
  const LoadedTarget loaded = parse(with(kAprilGrid, "tagSpacng", "0.3"));
  ASSERT_EQ(loaded.warnings.size(), 1U);
  EXPECT_NE(loaded.warnings[0].find("'tagSpacng'"), std::string::npos);
  EXPECT_NE(loaded.warnings[0].find("board.yaml:"), std::string::npos);
}

TEST(TargetYaml, EveryMissingKeyIsNamedInKalibrsWords) {
  for (const Keys& complete : {kAprilGrid, kCheckerboard, kCircleGrid}) {
    for (const auto& entry : complete) {
      Keys keys = complete;
      keys.erase(entry.first);
      const std::string expected =
          entry.first == "target_type"
              ? "Field 'target_type' missing in file: board.yaml"
              : "Calibration target configuration in board.yaml is missing the field: '" + entry.first + "'";
      expectMessage<InputError>([&] { parse(keys); }, {"[CalibrationTargetConfig Reader]: " + expected});
    }
  }
}

TEST(TargetYaml, ValuesOfAnotherTypeOrOutOfRangeAreNamed) {
  const auto expect_rejected = [](const Keys& base, const std::string& key, const std::string& value,
                                  const std::string& kalibr) {
    SCOPED_TRACE(key + ": " + value);
    expectMessage<InputError>([&] { parse(with(base, key, value)); },
                              {"[CalibrationTargetConfig Reader]: invalid " + kalibr, "board.yaml:"});
  };
  for (const std::string value : {"2", "0", "-6", "6.0", "six", "'6'", "[6]", "{a: 1}", "5000", "99999999999", "", "~"}) {
    expect_rejected(kAprilGrid, "tagRows", value, "tagRows (int>=3)");
    expect_rejected(kCheckerboard, "targetCols", value, "targetCols (int>=3)");
    expect_rejected(kCircleGrid, "targetRows", value, "targetRows (int>=3)");
  }
  for (const std::string value : {"0", "-0.1", "big", "'0.088'", ".nan", ".inf", "1e999", "0.1 m", "[0.1]", ""}) {
    expect_rejected(kAprilGrid, "tagSize", value, "tagSize (float>0)");
    expect_rejected(kAprilGrid, "tagSpacing", value, "tagSpacing (float>0)");
    expect_rejected(kCheckerboard, "rowSpacingMeters", value, "rowSpacingMeters (float>0)");
    expect_rejected(kCircleGrid, "spacingMeters", value, "spacingMeters (float>0)");
  }
  expect_rejected(kCircleGrid, "asymmetricGrid", "2", "asymmetricGrid (bool)");
  expect_rejected(kAprilGrid, "tagFamily", "t12h3", "tagFamily (one of ");
  expect_rejected(kAprilGrid, "codeOffset", "-1", "codeOffset (int from 0");
  expect_rejected(kAprilGrid, "codeOffset", "560", "codeOffset (int from 0 to 557");
  expect_rejected(kAprilGrid, "tagBorder", "3", "tagBorder (cells");
}

TEST(TargetYaml, AValueInQuotesIsCalledThat) {
  expectMessage<InputError>([] { parse(with(kAprilGrid, "tagSize", "'0.088'")); }, {"tagSize (float>0)", "in quotes"});
  expectMessage<InputError>([] { parse(with(kAprilGrid, "tagRows", "\"6\"")); }, {"tagRows (int>=3)", "in quotes"});
}

TEST(TargetYaml, ABoardWithMoreTagsThanTheFamilyIsRejected) {
  expectMessage<InputError>([] { parse(with(with(kAprilGrid, "tagRows", "100"), "tagCols", "100")); },
                            {"tagRows", "10000 tags", "587 codes"});
}

TEST(TargetYaml, AnUnknownTypeListsTheSupportedOnesInKalibrsWords) {
  expectMessage<InputError>([] { parse(with(kAprilGrid, "target_type", "deltille")); },
                            {"[CalibrationTargetConfig Reader]: Unknown calibration target type. Supported types: "
                             "['aprilgrid', 'checkerboard', 'circlegrid']",
                             "board.yaml", "deltille"});
}

TEST(TargetYaml, WhatIsNoYamlMapIsAnErrorWithFileAndReason) {
  for (const std::string text : {"target_type: [", "just text", "", "- 1\n- 2\n", "a: b: c\n", "\t\x01"}) {
    expectMessage<InputError>([&] { parseTarget(text, "board.yaml"); },
                              {"[CalibrationTargetConfig Reader]: Could not read configuration from", "board.yaml"});
  }
}

TEST(TargetYaml, AKeyThatIsThereTwiceIsAnErrorWithFileLineAndKey) {
  const std::string text = "target_type: aprilgrid\ntagCols: 6\ntagRows: 6\ntagSize: 0.088\ntagSpacing: 0.3\ntagSize: 0.8\n";
  expectMessage<InputError>([&] { parseTarget(text, "board.yaml"); }, {"board.yaml:6: ", "'tagSize'", "second time"});
}

TEST(TargetYaml, AMissingFileIsAnErrorInKalibrsWords) {
  const TemporaryFolder folder;
  const std::string path = folder.file("missing.yaml");
  expectMessage<InputError>(
      [&] { loadTarget(path); },
      {"[CalibrationTargetConfig Reader]: Could not read configuration from " + path, "No such file or directory"});
  expectMessage<InputError>([&] { loadTarget(folder.path().string()); }, {"Could not read", "Is a directory"});
}

TEST(TargetYaml, LoadsAFile) {
  const TemporaryFolder folder;
  writeFile(folder.file("board.yaml"), yaml(kCheckerboard));
  EXPECT_TRUE(std::holds_alternative<target::Checkerboard>(loadTarget(folder.file("board.yaml")).target));
}

TEST(TargetYaml, ReadsWhatItWrote) {
  const std::vector<target::Target> targets = {target::AprilGrid{3, 4, 1.0, 0.1 + 0.2, "t36h10", 7, 1},
                                               target::Checkerboard{7, 5, 1.0 / 3.0, 0.02},
                                               target::CircleGrid{4, 11, 0.02, true}};
  for (const target::Target& target : targets) {
    const std::string text = targetText(target);
    const LoadedTarget loaded = parseTarget(text, "written.yaml");
    EXPECT_EQ(targetText(loaded.target), text);
    EXPECT_EQ(target::cornerPoints(loaded.target), target::cornerPoints(target));
    EXPECT_TRUE(loaded.warnings.empty());
  }
  const auto grid = std::get<target::AprilGrid>(parseTarget(targetText(targets.front()), "written.yaml").target);
  EXPECT_EQ(grid.family, "t36h10");
  EXPECT_EQ(grid.code_offset, 7);
  EXPECT_EQ(grid.border_cells, 1);
}

TEST(TargetYaml, WritesLengthsThatStricterReadersTakeForFloats) {
  EXPECT_NE(targetText(target::AprilGrid{3, 4, 1.0, 2.0, "t36h11", 0, 2}).find("tagSize: 1.0\ntagSpacing: 2.0\n"),
            std::string::npos);
}

}  // namespace
}  // namespace tartan_calib::io
