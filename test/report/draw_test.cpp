#include "tartan_calib/report/draw.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <iterator>

#include "support/temporary_folder.h"
#include "tartan_calib/error.h"
#include "tartan_calib/pipeline/calibrate.h"

namespace tartan_calib::report {
namespace {

namespace fs = std::filesystem;

/// A folder with a script that stands for the one that draws.
class DrawTest : public testing::Test {
 protected:
  void draw(const std::string& script, const Listener& listener = {}) {
    std::ofstream(folder.file("script.py")) << script;
    drawReport(folder.file("script.py"), folder.path().string(), pdf, html, listener);
  }

  static std::string contents(const std::string& path) {
    std::ifstream file(path);
    return {std::istreambuf_iterator<char>(file), {}};
  }

  test_support::TemporaryFolder folder;
  const std::string pdf = folder.file("x-report-cam.pdf");
  const std::string html = folder.file("x-report-cam.html");
};

TEST_F(DrawTest, MovesWhatTheScriptDrew) {
  draw("import sys\nfor name in ('pdf', 'html'): open(sys.argv[1] + '/report.' + name, 'w').write(name)\n");
  EXPECT_EQ(contents(pdf), "pdf");
  EXPECT_EQ(contents(html), "html");
}

TEST_F(DrawTest, TellsTheLastLineOfAScriptThatFails) {
  try {
    draw("import sys\nprint('first')\nsys.exit('Python lacks matplotlib: install python3-matplotlib')\n");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "Python lacks matplotlib: install python3-matplotlib");
  }
  EXPECT_FALSE(fs::exists(pdf));
  EXPECT_FALSE(fs::exists(html));
}

TEST_F(DrawTest, KeepsAnOlderReportWhereTheScriptFails) {
  std::ofstream(pdf) << "old";
  EXPECT_THROW(draw("raise SystemExit(1)\n"), InputError);
  EXPECT_EQ(contents(pdf), "old");
}

TEST_F(DrawTest, TellsWhatTheScriptCounts) {
  std::size_t most = 0;
  std::size_t of = 0;
  Listener listener;
  listener.progress = [&](std::size_t done, std::size_t total) {
    most = std::max(most, done);
    of = total;
    if (done == 2) {
      std::ofstream(folder.file("seen")) << "seen";
    }
  };
  draw(
      "import os, sys, time\n"
      "open(sys.argv[1] + '/drawn', 'w').write('5\\n..')\n"
      "end_s = time.time() + 20\n"
      "while not os.path.exists(sys.argv[1] + '/seen') and time.time() < end_s: pass\n"
      "for name in ('pdf', 'html'): open(sys.argv[1] + '/report.' + name, 'w').close()\n",
      listener);
  EXPECT_EQ(most, 2U);
  EXPECT_EQ(of, 5U);
}

TEST_F(DrawTest, EndsTheScriptAndItsChildrenWhenCancelled) {
  const auto begin = std::chrono::steady_clock::now();
  EXPECT_THROW(draw("import subprocess, sys, time\nsubprocess.Popen(['sleep', '60'])\ntime.sleep(60)\n",
                    {nullptr, [] { return true; }}),
               pipeline::Cancelled);
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(20));
  EXPECT_FALSE(fs::exists(pdf));
}

}  // namespace
}  // namespace tartan_calib::report
