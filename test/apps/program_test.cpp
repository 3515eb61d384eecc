#include "common/program.h"

#include <gtest/gtest.h>

namespace tartan_calib::apps {
namespace {

using Words = std::vector<std::string>;

Words wordsOf(std::vector<const char*> arguments) {
  arguments.insert(arguments.begin(), "program");
  return commandWords(static_cast<int>(arguments.size()), arguments.data());
}

TEST(CommandWords, AreWithoutWhatRosRemaps) {
  EXPECT_EQ(wordsOf({"--topics", "/a", "__name:=calibrate_cameras", "--verbose", "__log:=/home/a b/x.log"}),
            (Words{"--topics", "/a", "--verbose"}));
  EXPECT_EQ(wordsOf({"_rate:=5", "image:=/cam0/image_raw", "/a/b:=/c", "~x:=", "__ns:=/"}), Words{});
}

TEST(CommandWords, KeepEverythingElse) {
  const Words words = {"--bag=a:=b", "a b:=c.bag", ":=", "C:\\rig.bag", "", "2:=3", "a:b", "./a:=b"};
  EXPECT_EQ(wordsOf({"--bag=a:=b", "a b:=c.bag", ":=", "C:\\rig.bag", "", "2:=3", "a:b", "./a:=b"}), words);
  EXPECT_EQ(wordsOf({}), Words{});
}

}  // namespace
}  // namespace tartan_calib::apps
