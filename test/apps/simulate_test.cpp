#include "simulate/simulate.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <opencv2/core.hpp>

#include "common/program.h"
#include "simulate/truth.h"
#include "tartan_calib/io/camchain.h"
#include "tartan_calib/io/corners_csv.h"
#include "tartan_calib/io/target_yaml.h"
#include "tartan_calib/ros/bag_reader.h"

namespace tartan_calib::apps {
namespace {

namespace fs = std::filesystem;

class Simulate : public ::testing::Test {
 protected:
  Simulate() : folder(fs::temp_directory_path() / ("simulate_test." + std::to_string(::getpid()))) {
    fs::create_directories(folder);
  }
  ~Simulate() override { fs::remove_all(folder); }

  std::string path(const std::string& name) const { return (folder / name).string(); }

  std::string bytes(const std::string& name) const {
    std::ifstream file(folder / name, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  }

  /// A small recording of two cameras with everything in it.
  SimulateOptions options(const std::vector<std::string>& output) const {
    std::vector<std::string> arguments = {"--preset", "sample", "--resolution", "160x128", "--views", "4"};
    arguments.insert(arguments.end(), output.begin(), output.end());
    return *parseSimulateOptions(arguments);
  }

  fs::path folder;
};

TEST_F(Simulate, WritesAFolderThatIsTheSameWithAnyNumberOfThreads) {
  simulate(options({"--output-dir", path("a"), "--threads", "1"}));
  simulate(options({"--output-dir", path("b"), "--threads", "3"}));
  int num_images = 0;
  for (const auto& entry : fs::recursive_directory_iterator(folder / "a")) {
    if (entry.is_regular_file()) {
      const fs::path relative = fs::relative(entry.path(), folder / "a");
      EXPECT_EQ(bytes("a" / relative), bytes("b" / relative)) << relative;
      ++num_images;
    }
  }
  EXPECT_EQ(num_images, 8);
  EXPECT_TRUE(fs::exists(folder / "a/cam1/1600000000250000000.png"));
  EXPECT_EQ(bytes("a-truth-corners.csv"), bytes("b-truth-corners.csv"));
}

TEST_F(Simulate, WritesItsTruthInTheFormatsOfACalibration) {
  const SimulateOptions asked = options({"--output-dir", path("run/"), "--hands", "1"});
  const SimulateSummary summary = simulate(asked);
  const simulation::Scene scene = makeScene(asked);

  const io::Camchain chain = io::loadCamchain(path("run-truth-camchain.yaml"));
  ASSERT_EQ(chain.rig.cameras.size(), 2U);
  for (std::size_t k = 0; k < 2; ++k) {
    EXPECT_EQ(camera::parameters(chain.rig.cameras[k].camera.model), camera::parameters(scene.cameras[k].camera.model));
    const geometry::Rigid3 off = chain.rig.cameras[k].T_cam_rig * scene.cameras[k].T_cam_rig.inverse();
    EXPECT_LT(geometry::logRigid(off).norm(), 1e-12);
  }
  EXPECT_EQ(chain.overlaps, (std::vector<std::vector<int>>{{1}, {0}}));
  EXPECT_EQ(target::numCorners(io::loadTarget(path("run-target.yaml")).target), 144);

  std::size_t num_visible = 0;
  std::size_t num_corners = 0;
  for (const pipeline::CameraCorners& camera : io::loadCorners(path("run-truth-corners.csv"))) {
    EXPECT_EQ(camera.width, 160);
    for (const observation::CameraView& image : camera.images) {
      for (const observation::Corner& corner : image.corners) {
        ++num_corners;
        num_visible += corner.used ? 1U : 0U;
      }
    }
  }
  EXPECT_EQ(num_corners, summary.num_corners);
  EXPECT_EQ(num_visible, summary.num_visible_corners);
  EXPECT_GT(num_visible, 200U);
  EXPECT_LT(num_visible, num_corners);
  const std::string visibility = bytes("run-truth-visibility.csv");
  std::size_t num_said_visible = 0;
  for (std::size_t at = visibility.find(",visible,"); at != std::string::npos; at = visibility.find(",visible,", at + 1)) {
    ++num_said_visible;
  }
  EXPECT_EQ(num_said_visible, num_visible);
  EXPECT_NE(visibility.find(",hidden,"), std::string::npos);
  EXPECT_EQ(bytes("run-truth-poses.csv").rfind("#timestamp", 0), 0U);
}

TEST_F(Simulate, WritesABagWithEveryCameraOnItsTopic) {
  const SimulateSummary summary = simulate(options({"--output-bag", path("run.bag")}));
  EXPECT_EQ(summary.base, path("run"));
  EXPECT_EQ(summary.num_images, 8U);
  EXPECT_TRUE(fs::exists(folder / "run-truth-camchain.yaml"));
  for (const pipeline::CameraStream& stream : ros::openBag(path("run.bag"), {"/cam0/image_raw", "/cam1/image_raw"}, {})) {
    EXPECT_EQ(stream.num_images, 4U);
    const auto first = stream.open()();
    ASSERT_TRUE(first);
    EXPECT_EQ(first->stamp_ns, 1600000000000000000);
    EXPECT_EQ(first->load().size(), cv::Size(160, 128));
  }
}

TEST_F(Simulate, TakesTheBoardOfAFile) {
  std::ofstream(folder / "board.yaml") << "target_type: 'checkerboard'\ntargetCols: 6\ntargetRows: 7\n"
                                          "rowSpacingMeters: 0.06\ncolSpacingMeters: 0.05\n";
  const simulation::Scene scene = makeScene(options({"--output-dir", path("run"), "--target", path("board.yaml")}));
  EXPECT_EQ(io::targetText(scene.target), bytes("board.yaml"));
}

TEST_F(Simulate, LeavesNothingBehindWhereItCannotWrite) {
  EXPECT_THROW(simulate(options({"--output-bag", path("missing/run.bag")})), InputError);
  fs::create_directories(folder / "there");
  EXPECT_THROW(simulate(options({"--output-dir", path("there")})), InputError);
  fs::remove(folder / "there");
  EXPECT_TRUE(fs::is_empty(folder));
}

TEST(SimulateOptions, ComeFromThePresetWhereTheyAreNotGiven) {
  const SimulateOptions options =
      *parseSimulateOptions({"--preset", "bf5m", "--views", "7", "--output-bag=x.bag", "--resolution", "612x512"});
  EXPECT_EQ(options.lens, "bf5m195");
  EXPECT_EQ(options.num_views, 7);
  EXPECT_EQ(options.hand_ratio, 0.3);
  EXPECT_EQ(options.height, 512);
  EXPECT_FALSE(parseSimulateOptions({"--help"}));
}

TEST(SimulateOptions, RefuseWhatMakesNoSense) {
  const std::vector<std::vector<std::string>> wrong = {
      {},  // no output
      {"--output-bag", "a", "--output-dir", "b"},
      {"--output-bag", "a", "--views", "0"},
      {"--output-bag", "a", "--views", "many"},
      {"--output-bag", "a", "--cameras", "3", "--models", "ds-none", "ds-none"},
      {"--output-bag", "a", "--resolution", "1000"},
      {"--output-bag", "a", "--hands", "2"},
      {"--output-bag", "a", "--rate", "nan"},
      {"--output-bag", "a", "--seed", "-1"},
      {"--output-bag", "a", "--baseline", "inf"},
      {"--output-bag", "a", "--preset", "none"},
      {"--output-bag", "a", "--unknown", "1"},
      {"--output-bag", "a", "stray"},
  };
  for (const std::vector<std::string>& arguments : wrong) {
    EXPECT_THROW(parseSimulateOptions(arguments), UsageError) << (arguments.empty() ? "nothing" : arguments.back());
  }
}

}  // namespace
}  // namespace tartan_calib::apps
