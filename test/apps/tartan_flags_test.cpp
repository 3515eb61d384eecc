#include "tartan_calibrate/tartan_flags.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "calibrate_cameras/arguments.h"
#include "common/program.h"
#include "support/expect_message.h"

namespace tartan_calib::apps {
namespace {

using Words = std::vector<std::string>;

const Words kComplete = {"--bag", "rig.bag", "--topics", "/a", "--models", "ds-none", "--target", "t.yaml"};

Arguments argumentsOf(const Words& words) {
  Words all = kComplete;
  all.insert(all.end(), words.begin(), words.end());
  return parseArguments(translateTartanFlags(all).words);
}

void expectUsageError(const Words& words, const std::string& part) {
  test_support::expectMessage<UsageError>([&words] { argumentsOf(words); }, {part});
}

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

TEST(TartanFlags, HandOnWhatIsNotTheirs) {
  EXPECT_EQ(translateTartanFlags(kComplete).words, kComplete);
  EXPECT_TRUE(translateTartanFlags(kComplete).notes.empty());
}

TEST(TartanFlags, HaveTartanCalibsDefaults) {
  const TartanCommand command = translateTartanFlags({});
  EXPECT_EQ(command.save_dir, "/data/");
  EXPECT_EQ(command.log_dest, "log");
  EXPECT_TRUE(command.debug_modes.empty());
}

TEST(TartanFlags, TakeDashesForUnderscoresAndShortForms) {
  const TartanCommand command = translateTartanFlags(
      {"--save-dir", "/tmp/a", "--log_d=b", "--debug_image_dir", "c/", "--debug-m", "none", "reprojectionpoints"});
  EXPECT_EQ(command.save_dir, "/tmp/a");
  EXPECT_EQ(command.log_dest, "b");
  EXPECT_EQ(command.debug_image_dir, "c/");
  EXPECT_EQ(command.debug_modes, Words{"reprojectionpoints"});
  EXPECT_TRUE(command.words.empty());
}

TEST(TartanFlags, LookInViewsAloneUnlessTheCornerPredictorIsNamed) {
  EXPECT_GT(argumentsOf({}).calibrate.max_rounds, 0);
  EXPECT_GT(argumentsOf({"--projections", "cornerpredictor"}).calibrate.max_rounds, 0);
  EXPECT_EQ(argumentsOf({"--projections", "none"}).calibrate.max_rounds, 0);
  const Arguments alone = argumentsOf({"--projections", "pinhole", "--fovs", "90", "--fovs", "90"});
  EXPECT_EQ(alone.calibrate.max_rounds, 0);
  EXPECT_EQ(alone.calibrate.projections.pinholes.size(), 1U);
  EXPECT_GT(argumentsOf({"--projections", "pinhole", "cornerpredictor"}).calibrate.max_rounds, 0);
  EXPECT_EQ(argumentsOf({"--projections", "pinhole", "--max-rounds", "3"}).calibrate.max_rounds, 3);
}

TEST(TartanFlags, TakeAllProjectionsThatAreGivenOneByOne) {
  const auto options = [](const Words& words) { return argumentsOf(words).calibrate; };
  const auto with_rounds = options({"--projections", "pinhole", "--projections", "cornerpredictor"});
  EXPECT_EQ(with_rounds.projections.pinholes.size(), 1U);
  EXPECT_GT(with_rounds.max_rounds, 0);
  const Words views = {"--projections", "pinhole", "--projections=homography", "--poses", "0", "0", "--poses", "0", "0"};
  const auto alone = options(views);
  EXPECT_EQ(alone.projections.pinholes.size(), 1U);
  EXPECT_TRUE(alone.projections.rectified);
  EXPECT_EQ(alone.max_rounds, 0);
  EXPECT_EQ(translateTartanFlags(views).notes.size(), 1U);
}

TEST(TartanFlags, OfViewsAloneHaveNoEffectOnTheDefaultProjections) {
  for (const char* flag : {"--fovs", "--poses", "--resolutions"}) {
    const Arguments arguments = argumentsOf({flag, "90", flag, "90"});
    EXPECT_TRUE(arguments.calibrate.projections.empty()) << flag;
    EXPECT_GT(arguments.calibrate.max_rounds, 0) << flag;
    ASSERT_EQ(arguments.notes.size(), 1U) << flag;
    EXPECT_TRUE(contains(arguments.notes[0], std::string(flag) + " has no effect: ")) << arguments.notes[0];
  }
}

TEST(TartanFlags, SayThatRoundsAreLeftOutWhereTheyAre) {
  const auto is_told = [](const Words& words) {
    const Words notes = translateTartanFlags(words).notes;
    return std::any_of(notes.begin(), notes.end(), [](const auto& note) { return contains(note, "add cornerpredictor"); });
  };
  EXPECT_TRUE(is_told({"--projections", "cube"}));
  EXPECT_FALSE(is_told({"--projections", "cube", "--max_rounds=3"}));
  EXPECT_FALSE(is_told({"--projections", "cube", "--projections", "cornerpredictor"}));
  EXPECT_EQ(translateTartanFlags({"--projections", "none"}).notes,
            Words{"--projections none: corners are not looked for at their predictions"});
}

TEST(TartanFlags, TakeProjectionsWithoutAValueAsNone) {
  const auto options = argumentsOf({"--projections"}).calibrate;
  EXPECT_TRUE(options.projections.empty());
  EXPECT_EQ(options.max_rounds, 0);
}

TEST(TartanFlags, LetAnExplicitFilterWinOverTheThresholdThatImpliesOne) {
  const Words words = {"--correction_threshold", "10.1", "--corner-filt=image"};
  EXPECT_EQ(argumentsOf(words).calibrate.recovery.filter, detection::CornerFilter::kImage);
  EXPECT_EQ(translateTartanFlags(words).notes,
            Words{"--correction_threshold has no effect: --corner-filter image looks for no quadrilaterals"});
}

TEST(TartanFlags, TakeTheCorrectionThresholdInSquaredPixels) {
  const auto recovery = argumentsOf({"--correction-threshold", "6.25"}).calibrate.recovery;
  EXPECT_EQ(recovery.filter, detection::CornerFilter::kQuads);
  EXPECT_DOUBLE_EQ(recovery.max_quad_distance_px, 2.5);
  EXPECT_EQ(argumentsOf({}).calibrate.recovery.filter, detection::CornerFilter::kImage);
  expectUsageError({"--correction-threshold", "-1"}, "must be above 0");
  expectUsageError({"--correction-threshold", "near"}, "needs a number, not 'near'");
}

TEST(TartanFlags, LimitsOfWindowsChooseAdaptiveRefinementUnlessSymmetryIsAskedFor) {
  const Words limits = {"--min-resize-window-size", "3", "--max_resize_window_size=6"};
  const auto adaptive = argumentsOf(limits).calibrate.recovery;
  EXPECT_EQ(adaptive.refinement, detection::Refinement::kAdaptive);
  EXPECT_EQ(adaptive.adaptive_window.min_half_window_px, 3);
  EXPECT_EQ(adaptive.adaptive_window.max_half_window_px, 6);
  EXPECT_EQ(argumentsOf({"--symmetry-refinement"}).calibrate.recovery.refinement, detection::Refinement::kSymmetry);
  for (const bool first : {true, false}) {
    Words both = limits;
    both.insert(first ? both.begin() : both.end(), "--symmetry-refinement");
    EXPECT_EQ(argumentsOf(both).calibrate.recovery.refinement, detection::Refinement::kSymmetry);
    EXPECT_EQ(translateTartanFlags(both).notes.size(), 2U);
  }
  expectUsageError({"--min-resize-window-size", "small"}, "needs a number, not 'small'");
  expectUsageError({"--min-resize-window-size", "2.7"}, "needs whole pixels, not '2.7'");
}

TEST(TartanFlags, KnowTheRefinementInEverySpelling) {
  for (const Words& symmetry :
       {Words{"--refinement=symmetry"}, Words{"--refinem", "symmetry"}, Words{"--refinem=symmetry"}}) {
    Words words = symmetry;
    words.insert(words.end(), {"--min-resize-window-size", "3"});
    EXPECT_EQ(argumentsOf(words).calibrate.recovery.refinement, detection::Refinement::kSymmetry) << symmetry[0];
    EXPECT_EQ(translateTartanFlags(words).notes.size(), 1U) << symmetry[0];
  }
  const Words last = {"--refinement", "symmetry", "--refinement=adaptive", "--min-resize-window-size", "3"};
  EXPECT_EQ(argumentsOf(last).calibrate.recovery.adaptive_window.min_half_window_px, 3);
}

TEST(TartanFlags, SayWhyAFlagHasNoEffect) {
  for (const Words& words :
       {Words{"--min-init-corners-autocomplete", "24"}, Words{"--min-tag-size-autocomplete", "0"},
        Words{"--refine-magnitude-reject", "2.0"}, Words{"--symmetry-edge-threshold", "10"}, Words{"--polar_setting", "1"},
        Words{"--polar_cutoff", "50"}, Words{"--force_all"}, Words{"--outputMatlab"}, Words{"--export-dataset-dir", "x.bin"},
        Words{"--qr-tol", "0.02"}, Words{"--mi-tol", "-1"}, Words{"--no-shuffle"}, Words{"--plot"}, Words{"--plot-outliers"},
        Words{"--plot-o"}, Words{"--show-extraction"}}) {
    const TartanCommand command = translateTartanFlags(words);
    EXPECT_TRUE(command.words.empty()) << words[0];
    ASSERT_EQ(command.notes.size(), 1U) << words[0];
    EXPECT_TRUE(contains(command.notes[0], words[0] + " has no effect: ")) << command.notes[0];
  }
  EXPECT_EQ(translateTartanFlags({"--outputMatlab"}).notes,
            Words{"--outputMatlab has no effect: no files of MATLAB's are written; --export-corners writes the corners"});
}

TEST(TartanFlags, OfPicturesOfImagesHaveNoEffectWhereThereAreCorners) {
  const Words modes = {"--debug-modes", "originalprojection", "reprojectionpoints", "individualprojections"};
  EXPECT_EQ(translateTartanFlags(modes).debug_modes.size(), 3U);
  Words words = modes;
  words.emplace_back("--corners=c.csv");
  const TartanCommand command = translateTartanFlags(words);
  EXPECT_EQ(command.debug_modes, Words{"reprojectionpoints"});
  EXPECT_EQ(command.notes,
            Words{"--debug-modes originalprojection individualprojections has no effect: --corners brings no images"});
}

TEST(TartanFlags, TellThatTheDefaultViewLooksSideways) {
  const auto is_told = [](const Words& words) {
    const TartanCommand command = translateTartanFlags(words);
    return !command.notes.empty() && contains(command.notes.back(), "-y axis");
  };
  EXPECT_TRUE(is_told({"--projections", "pinhole"}));
  EXPECT_FALSE(is_told({"--projections", "pinhole", "--poses", "0", "--poses", "0"}));
  EXPECT_FALSE(is_told({"--projections", "cube"}));
}

TEST(TartanFlags, NameWhatIsWrong) {
  expectUsageError({"--debug-modes", "everything"}, "everything");
  expectUsageError({"--save_dir"}, "--save_dir needs a value");
  expectUsageError({"--mi-tol", "small"}, "--mi-tol needs a number, not 'small'");
  expectUsageError({"--debug", "none"}, "ambiguous");
  expectUsageError({"--no-such-flag"}, "no-such-flag");
  expectUsageError({"--projections", "fisheye"}, "fisheye");
}

}  // namespace
}  // namespace tartan_calib::apps
