#include "calibrate_cameras/rig_file.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "calibrate_cameras/arguments.h"
#include "common/program.h"

namespace tartan_calib::apps {
namespace {

using Words = std::vector<std::string>;

class RigFile : public testing::Test {
 protected:
  void SetUp() override { std::filesystem::create_directories(folder); }
  void TearDown() override { std::filesystem::remove_all(folder); }

  std::string write(const std::string& text) const {
    std::string file = (folder / "rig.yaml").string();
    std::ofstream(file) << text;
    return file;
  }

  std::string errorOf(const std::string& text) const {
    try {
      withRigFile({"--rig", write(text)});
    } catch (const InputError& error) {
      return error.what();
    }
    return "no error";
  }

  const std::filesystem::path folder =
      std::filesystem::path(testing::TempDir()) / testing::UnitTest::GetInstance()->current_test_info()->name();
};

TEST_F(RigFile, WordsWithoutTheFlagStayAsTheyAre) {
  const Words words = {"--bag", "a.bag", "--topics", "/a"};
  EXPECT_EQ(withRigFile(words), words);
}

TEST_F(RigFile, ItsKeysAreFlagsBeforeThoseOfTheCommandLine) {
  const std::string file = write("topics: [/a, /b]\nexport-poses: true\nverbose: false\napprox-sync: 0.005\n");
  const Words expected = {"--topics", "/a",    "/b",    "--export-poses", "--approx-sync",
                          "0.005",    "--bag", "x.bag", "--threads",      "1"};
  EXPECT_EQ(withRigFile({"--bag", "x.bag", "--rig", file, "--threads", "1"}), expected);
  EXPECT_EQ(withRigFile({"--bag", "x.bag", "--rig=" + file, "--threads", "1"}), expected);
}

TEST_F(RigFile, IsFoundByAShortenedFlagAndOnlyOnce) {
  const std::string file = write("target: t.yaml\nmodels: ds-none\ntopics: /a\n");
  EXPECT_EQ(parseArguments({"--ri", file, "--bag", "x.bag"}).topics, (Words{"/a"}));
  EXPECT_THROW(parseArguments({"--rig", file, "--bag", "x.bag", "--rig", file}), UsageError);
}

TEST_F(RigFile, FileNamesAreRelativeToIt) {
  const Words words = withRigFile({"--rig", write("target: ../board.yaml\ninit: /abs/camchain.yaml\n")});
  EXPECT_EQ(words, (Words{"--target", (folder.parent_path() / "board.yaml").lexically_normal().string(), "--init",
                          "/abs/camchain.yaml"}));
}

TEST_F(RigFile, TheExampleOfTheRepositoryIsAWholeCommandLineButForTheBag) {
  const std::string example = TARTAN_CALIB_SOURCE_DIR "/config/rigs/example_stereo.yaml";
  const Arguments arguments = parseArguments({"--rig", example, "--bag", "today.bag", "--models", "ds-none", "ds-none"});
  EXPECT_EQ(arguments.topics, (Words{"/cam0/image_raw", "/cam1/image_raw"}));
  EXPECT_EQ(arguments.calibrate.models, (Words{"ds-none", "ds-none"}));
  EXPECT_TRUE(std::filesystem::exists(arguments.target_file)) << arguments.target_file;
}

TEST_F(RigFile, WhatIsWrongInItIsNamed) {
  EXPECT_NE(errorOf("models: [a\n").find("is no YAML: line 2"), std::string::npos) << errorOf("models: [a\n");
  EXPECT_NE(errorOf("ds-none\n").find("key: value"), std::string::npos);
  EXPECT_NE(errorOf("models: {cam0: ds-none}\n").find("models needs a value"), std::string::npos);
  EXPECT_NE(errorOf("bag: x.bag\n? [models, topics]\n: ds-none\n").find("line 2: the key must be"), std::string::npos);
  EXPECT_THROW(withRigFile({"--rig", "nowhere.yaml"}), InputError);
  EXPECT_THROW(withRigFile({"--rig"}), UsageError);
  EXPECT_THROW(parseArguments({"--rig", write("modells: [ds-none]\n")}), UsageError);
}

}  // namespace
}  // namespace tartan_calib::apps
