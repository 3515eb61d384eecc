#include "calibrate_cameras/outputs.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>

#include "calibrate_cameras/session.h"

namespace tartan_calib::apps {
namespace {

namespace fs = std::filesystem;

std::string prefixOf(const std::string& recording, const std::string& corners = "") {
  Arguments arguments;
  arguments.recording = recording;
  arguments.corners_file = corners;
  return outputPrefix(arguments);
}

TEST(CommandText, IsReadBackByAShell) {
  EXPECT_EQ(commandText("calibrate", {"--bag", "a/b.bag", "--approx-sync=0.02"}),
            "calibrate --bag a/b.bag --approx-sync=0.02");
  EXPECT_EQ(commandText("calibrate", {"--bag", "a b.bag", "it's", "$x", ""}),
            R"(calibrate --bag 'a b.bag' 'it'\''s' '$x' '')");
}

TEST(OutputPrefix, OfABagIsItsPathWithoutTheLastExtension) {
  EXPECT_EQ(prefixOf("rig.bag"), "rig");
  EXPECT_EQ(prefixOf("/data.d/rig.orig.bag"), "/data.d/rig.orig");
  EXPECT_EQ(prefixOf("data.d/rig"), "data.d/rig");
  EXPECT_EQ(prefixOf(".hidden"), ".hidden");
}

TEST(OutputPrefix, OfAFolderIsItsPath) {
  const fs::path folder = fs::temp_directory_path() / ("outputs_test.d" + std::to_string(::getpid()));
  fs::create_directories(folder);
  const fs::path before = fs::current_path();
  EXPECT_EQ(prefixOf(folder.string()), folder.string());
  EXPECT_EQ(prefixOf(folder.string() + "/"), folder.string());
  fs::current_path(folder);
  EXPECT_EQ(prefixOf("."), fs::canonical(folder).string());
  EXPECT_EQ(prefixOf("./"), fs::canonical(folder).string());
  fs::current_path(before);
  fs::remove_all(folder);
}

TEST(OutputPrefix, OfCornersIsThatOfTheRecordingTheyCameFrom) {
  EXPECT_EQ(prefixOf("", "a/rig-corners.csv"), "a/rig");
  EXPECT_EQ(prefixOf("", "a/other.csv"), "a/other");
  EXPECT_EQ(prefixOf("b/rig.bag", "a/other.csv"), "b/rig");
}

TEST(CheckWritable, NamesAFolderThatIsNotThere) {
  EXPECT_NO_THROW(checkWritable("rig"));
  EXPECT_NO_THROW(checkWritable((fs::temp_directory_path() / "rig").string()));
  EXPECT_THROW(checkWritable("/nowhere/rig"), InputError);
}

}  // namespace
}  // namespace tartan_calib::apps
