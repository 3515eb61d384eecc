#include "calibrate_cameras/arguments.h"

#include <gtest/gtest.h>

#include "calibrate_cameras/flags.h"
#include "common/program.h"
#include "support/expect_message.h"

namespace tartan_calib::apps {
namespace {

using Words = std::vector<std::string>;

/// A complete command line and further words.
Words commandWith(const Words& words) {
  Words command = {"--bag", "rig.bag", "--topics", "/a", "/b", "--models", "ds-none", "pinhole-equi", "--target", "t.yaml"};
  command.insert(command.end(), words.begin(), words.end());
  return command;
}

Arguments parsedWith(const Words& words) { return parseArguments(commandWith(words)); }

void expectUsageError(const Words& words, const std::string& part) {
  test_support::expectMessage<UsageError>([&words] { parseArguments(words); }, {part});
}

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

TEST(Arguments, HaveKalibrsDefaults) {
  const Arguments arguments = parsedWith({});
  EXPECT_EQ(arguments.recording, "rig.bag");
  EXPECT_EQ(arguments.topics, (Words{"/a", "/b"}));
  EXPECT_EQ(arguments.calibrate.models, (Words{"ds-none", "pinhole-equi"}));
  EXPECT_EQ(arguments.target_file, "t.yaml");
  EXPECT_FALSE(arguments.selection.window.has_value());
  EXPECT_FALSE(arguments.selection.max_rate_hz.has_value());
  EXPECT_EQ(arguments.calibrate.approx_sync_ns, 20'000'000);
  EXPECT_EQ(arguments.calibrate.solve.min_views_outlier, 20);
  EXPECT_TRUE(arguments.calibrate.solve.remove_outliers);
  EXPECT_TRUE(arguments.calibrate.solve.final_filtering);
  EXPECT_FALSE(arguments.calibrate.solve.use_blake_zisserman);
  EXPECT_FALSE(arguments.export_poses);
  EXPECT_FALSE(arguments.export_corners);
}

TEST(Arguments, ChooseTheRefinementAndItsWindow) {
  const auto recovery = [](const Words& words) { return parsedWith(words).calibrate.recovery; };
  EXPECT_EQ(recovery({}).refinement, detection::Refinement::kSymmetry);
  EXPECT_EQ(recovery({"--refinement", "fixed"}).refinement, detection::Refinement::kFixed);
  EXPECT_DOUBLE_EQ(recovery({"--symmetry-window", "1.5"}).symmetry_window, 1.5);
  const detection::RecoveryOptions adaptive = recovery({"--refinement", "adaptive", "--window-scale", "0.3",
                                                        "--min-resize-window-size", "3", "--max-resize-window-size", "9"});
  EXPECT_EQ(adaptive.refinement, detection::Refinement::kAdaptive);
  EXPECT_DOUBLE_EQ(adaptive.adaptive_window.scale, 0.3);
  EXPECT_EQ(adaptive.adaptive_window.min_half_window_px, 3);
  EXPECT_EQ(adaptive.adaptive_window.max_half_window_px, 9);
}

TEST(Arguments, NameWhatIsWrongWithARefinement) {
  expectUsageError(commandWith({"--refinement", "best"}), "symmetry, adaptive or fixed, not 'best'");
  expectUsageError(commandWith({"--symmetry-window", "0"}), "--symmetry-window must be above 0");
  expectUsageError(commandWith({"--refinement", "fixed", "--symmetry-window", "1"}), "needs --refinement symmetry");
  expectUsageError(commandWith({"--window-scale", "0.5"}), "--window-scale needs --refinement adaptive");
  expectUsageError(commandWith({"--refinement", "adaptive", "--window-scale", "-1"}), "--window-scale must be above 0");
  expectUsageError(commandWith({"--refinement", "adaptive", "--min-resize-window-size", "9"}), "the first the smaller");
}

TEST(Arguments, TakeTheThresholdOfQuadsWithThemOnly) {
  const auto recovery = parsedWith({"--corner-filter", "quads", "--correction-threshold", "3.18"}).calibrate.recovery;
  EXPECT_DOUBLE_EQ(recovery.max_quad_distance_px, 3.18);
  expectUsageError(commandWith({"--correction-threshold", "3.18"}), "--correction-threshold needs --corner-filter quads");
  expectUsageError(commandWith({"--corner-filter", "image", "--correction-threshold", "3"}), "needs --corner-filter quads");
}

TEST(Arguments, ThatNeedImagesAreNamedWhereThereAreCorners) {
  const Words of_images = {"--max-rounds", "3", "--projections", "cube", "--corner-filter", "quads"};
  EXPECT_TRUE(parsedWith(of_images).notes.empty());
  Words words = of_images;
  words.insert(words.end(), {"--corners", "c.csv"});
  EXPECT_EQ(parsedWith(words).notes,
            (Words{"--max-rounds, --corner-filter, --projections have no effect: --corners brings no images"}));
  EXPECT_TRUE(parsedWith({"--corners", "c.csv", "--min-tags", "3"}).notes.empty());
}

TEST(Arguments, ThatDescribeNoViewAreNamed) {
  const Words rows = {"--fovs",  "90", "--fovs",        "90",  "--poses",       "0",
                      "--poses", "0",  "--resolutions", "500", "--resolutions", "500"};
  const auto notes = [&rows](const std::string& projection) {
    Words words = {"--projections", projection};
    words.insert(words.end(), rows.begin(), rows.end());
    return parsedWith(words).notes;
  };
  EXPECT_TRUE(notes("pinhole").empty());
  EXPECT_EQ(notes("cube"), Words{"--poses has no effect: it describes views of --projections pinhole"});
  EXPECT_EQ(notes("homography").size(), 2U);
  EXPECT_EQ(notes("cornerpredictor").size(), 3U);
}

TEST(Arguments, SetEveryOption) {
  const Arguments arguments = parsedWith({"--bag-from-to",
                                          "2.5",
                                          "60",
                                          "--bag-freq=4.0",
                                          "--approx-sync",
                                          "0.001",
                                          "--no-outliers-removal",
                                          "--no-final-filtering",
                                          "--min-views-outlier",
                                          "7",
                                          "--use-blakezisserman",
                                          "--verbose",
                                          "--export-poses",
                                          "--init",
                                          "old.yaml",
                                          "--fix",
                                          "intrinsics",
                                          "--fix",
                                          "cam1",
                                          "--estimate-board-warp",
                                          "--linear-solver",
                                          "sparse",
                                          "--threads",
                                          "3",
                                          "--export-corners",
                                          "--min-tags",
                                          "3",
                                          "--min-border-distance",
                                          "1.5",
                                          "--corners",
                                          "c.csv"});
  EXPECT_EQ(arguments.selection.window->from_s, 2.5);
  EXPECT_EQ(arguments.selection.window->to_s, 60.0);
  EXPECT_EQ(arguments.selection.max_rate_hz, 4.0);
  EXPECT_EQ(arguments.calibrate.approx_sync_ns, 1'000'000);
  EXPECT_FALSE(arguments.calibrate.solve.remove_outliers);
  EXPECT_FALSE(arguments.calibrate.solve.final_filtering);
  EXPECT_EQ(arguments.calibrate.solve.min_views_outlier, 7);
  EXPECT_TRUE(arguments.calibrate.solve.use_blake_zisserman);
  EXPECT_TRUE(arguments.verbose);
  EXPECT_TRUE(arguments.export_poses);
  EXPECT_EQ(arguments.init_file, "old.yaml");
  EXPECT_TRUE(arguments.calibrate.solve.fix_intrinsics);
  EXPECT_FALSE(arguments.calibrate.solve.fix_extrinsics);
  EXPECT_EQ(arguments.calibrate.solve.fixed_cameras, (std::vector<int>{1}));
  EXPECT_TRUE(arguments.calibrate.solve.estimate_board_warp);
  EXPECT_EQ(arguments.calibrate.solve.linear_solver, calibration::LinearSolver::kSparse);
  EXPECT_EQ(arguments.calibrate.num_threads, 3);
  EXPECT_EQ(arguments.calibrate.min_tags, 3);
  EXPECT_EQ(arguments.calibrate.detector.min_border_distance_px, 1.5);
  EXPECT_TRUE(arguments.export_corners);
  EXPECT_EQ(arguments.corners_file, "c.csv");
}

TEST(Arguments, AcceptWhatHasNoEffectHere) {
  EXPECT_NO_THROW(
      parsedWith({"--qr-tol", "0.02", "--mi-tol", "-1", "--no-shuffle", "--plot", "--plot-outliers", "--show-extraction"}));
}

TEST(Arguments, ChooseWhetherThereIsAReportAndWhetherItIsShown) {
  EXPECT_TRUE(parsedWith({}).report);
  EXPECT_TRUE(parsedWith({}).show_report);
  EXPECT_FALSE(parsedWith({"--no-report"}).report);
  EXPECT_FALSE(parsedWith({"--dont-show-report"}).show_report);
  EXPECT_TRUE(parsedWith({"--dont-show-report"}).report);
}

TEST(Arguments, MayBeCutShort) {
  const Arguments arguments =
      parseArguments({"--topic", "/a", "--model", "ds-none", "--ta", "t.yaml", "--bag", "a.bag", "--bag-fre", "2"});
  EXPECT_EQ(arguments.topics, Words{"/a"});
  EXPECT_EQ(arguments.selection.max_rate_hz, 2.0);
}

TEST(Arguments, CutShortMeanKalibrsFlagWhereKalibrHasOnlyOne) {
  const Arguments arguments = parsedWith({"--export"});
  EXPECT_TRUE(arguments.export_poses);
  EXPECT_FALSE(arguments.export_corners);
}

TEST(Arguments, CutShortTooFarAreRefusedWithTheCandidates) {
  expectUsageError(commandWith({"--no"}), "--no-shuffle");
  expectUsageError(commandWith({"--no"}), "--no-final-filtering");
}

TEST(Arguments, MayUseUnderscores) {
  EXPECT_FALSE(parsedWith({"--no_final_filtering"}).calibrate.solve.final_filtering);
  EXPECT_EQ(parsedWith({"--bag_freq=3"}).selection.max_rate_hz, 3.0);
  EXPECT_EQ(parsedWith({"--init=my_chain.yaml"}).init_file, "my_chain.yaml");
}

TEST(Arguments, TakeNegativeNumbersAsValues) {
  EXPECT_EQ(parsedWith({"--bag-from-to", "-1", "5"}).selection.window->from_s, -1.0);
  expectUsageError(commandWith({"--approx-sync", "-1"}), "--approx-sync");
}

TEST(Arguments, CountTheLastOfAFlagGivenTwice) {
  EXPECT_EQ(parsedWith({"--bag-freq", "1", "--bag-freq", "2"}).selection.max_rate_hz, 2.0);
  EXPECT_EQ(parsedWith({"--topics", "/c", "/d"}).topics, (Words{"/c", "/d"}));
}

TEST(Arguments, ThatAreWrongAreNamed) {
  expectUsageError(commandWith({"--colour"}), "--colour");
  expectUsageError(commandWith({"--bag-freq", "fast"}), "fast");
  expectUsageError(commandWith({"--bag-freq"}), "--bag-freq");
  expectUsageError(commandWith({"--verbose", "word"}), "word");
  expectUsageError(commandWith({"--bag-from-to", "1"}), "--bag-from-to");
  expectUsageError(commandWith({"--min-views-outlier", "0"}), "--min-views-outlier");
  expectUsageError(commandWith({"--threads", "-2"}), "--threads");
  expectUsageError(commandWith({"--min-tags", "0"}), "--min-tags");
  expectUsageError(commandWith({"--min-border-distance", "-1"}), "--min-border-distance");
  expectUsageError(commandWith({"--linear-solver", "qr"}), "qr");
  expectUsageError(commandWith({"--corner-filter", "none"}), "'none'");
  expectUsageError(commandWith({"--corner-filter", "quads", "--correction-threshold", "0"}),
                   "--correction-threshold must be");
  expectUsageError(commandWith({"--init", "a.yaml", "--fix", "camera1"}), "camera1");
  expectUsageError(commandWith({"--fix", "cam1"}), "--init");
}

TEST(Arguments, ThatAreMissingAreNamed) {
  expectUsageError({"--topics", "/a", "--models", "ds-none", "--bag", "a.bag"}, "--target");
  expectUsageError({"--topics", "/a", "--models", "ds-none", "--target", "t"}, "--bag");
  expectUsageError({"--topics", "/a", "--bag", "a.bag", "--target", "t"}, "--models");
  expectUsageError({"--models", "ds-none", "--bag", "a.bag", "--target", "t"}, "--topics");
  expectUsageError(commandWith({"--models", "ds-none"}), "one camera model per topic");
}

TEST(Arguments, MayLeaveOutWhatAnotherFileNames) {
  EXPECT_NO_THROW(parseArguments({"--corners", "c.csv", "--models", "ds-none", "--target", "t"}));
  EXPECT_NO_THROW(parseArguments({"--bag", "a.bag", "--init", "chain.yaml", "--target", "t"}));
}

TEST(Arguments, AskForHelpWithoutTheRest) {
  EXPECT_TRUE(parseArguments({"-h"}).help);
  EXPECT_TRUE(parseArguments({"--help"}).help);
}

TEST(Arguments, AFlagIsNoValueOfTheOneBefore) {
  try {
    parseArguments({"--bag", "x.bag", "--target", "t.yaml", "--topics", "--models", "ds-none"});
    ADD_FAILURE() << "nothing was thrown";
  } catch (const UsageError& error) {
    EXPECT_NE(std::string(error.what()).find("between --topics and --models"), std::string::npos) << error.what();
  }
}

TEST(Help, NamesEveryFlag) {
  Words flags = kalibrFlags();
  const Words own = ownFlags();
  flags.insert(flags.end(), own.begin(), own.end());
  for (const std::string& flag : flags) {
    const bool is_there = contains(helpText(), "--" + flag + " ") || contains(helpText(), "--" + flag + "\n");
    EXPECT_TRUE(is_there) << flag;
  }
}

TEST(FocalHint, IsANumberOfPixelsAboveTen) {
  EXPECT_EQ(focalHint("420.5"), 420.5);
  EXPECT_EQ(focalHint(nullptr), std::nullopt);
  for (const char* value : {"1", "10", "-500", "true", "", "500 px", "inf", "nan", "1e6", "1e9"}) {
    EXPECT_EQ(focalHint(value), std::nullopt) << value;
  }
}

}  // namespace
}  // namespace tartan_calib::apps
