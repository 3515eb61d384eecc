#include "common/progress_bar.h"

#include <gtest/gtest.h>

namespace tartan_calib::apps {
namespace {

TEST(DurationText, ShowsTheTwoLargestUnits) {
  EXPECT_EQ(durationText(0.4), "0s");
  EXPECT_EQ(durationText(59.4), "59s");
  EXPECT_EQ(durationText(59.6), "1m 00s");
  EXPECT_EQ(durationText(185.0), "3m 05s");
  EXPECT_EQ(durationText(3725.0), "1h 02m");
}

/// What a bar prints of `total` items of which each takes `seconds_per_item`.
std::string printed(bool is_terminal, std::size_t total, double seconds_per_item) {
  ProgressBar::Clock::time_point now;
  ProgressBar bar(is_terminal, [&now] { return now; });
  testing::internal::CaptureStdout();
  for (std::size_t done = 0; done <= total; ++done) {
    bar.show(done, total);
    now += std::chrono::duration_cast<ProgressBar::Clock::duration>(std::chrono::duration<double>(seconds_per_item));
  }
  bar.clear();
  return testing::internal::GetCapturedStdout();
}

TEST(ProgressBar, InALogIsALineForATenthOfTheWork) {
  EXPECT_EQ(printed(false, 100, 1.0),
            "  Progress 10 / 100 \t Time remaining: 1m 30s\n  Progress 20 / 100 \t Time remaining: 1m 20s\n"
            "  Progress 30 / 100 \t Time remaining: 1m 10s\n  Progress 40 / 100 \t Time remaining: 1m 00s\n"
            "  Progress 50 / 100 \t Time remaining: 50s\n  Progress 60 / 100 \t Time remaining: 40s\n"
            "  Progress 70 / 100 \t Time remaining: 30s\n  Progress 80 / 100 \t Time remaining: 20s\n"
            "  Progress 90 / 100 \t Time remaining: 10s\n");
}

TEST(ProgressBar, InALogIsSilentWhereLittleIsLeft) {
  EXPECT_EQ(printed(false, 100, 0.055), "  Progress 37 / 100 \t Time remaining: 3s\n");
  EXPECT_EQ(printed(false, 100, 0.03), "");
}

TEST(ProgressBar, OnATerminalIsRedrawnInItsLineAndCleared) {
  EXPECT_EQ(printed(true, 3, 0.15),
            "\r\x1b[K  Progress 1 / 3 \t Time remaining: 0s\r\x1b[K  Progress 2 / 3 \t Time remaining: 0s"
            "\r\x1b[K  Progress 3 / 3 \t Time remaining: 0s\r\x1b[K");
}

}  // namespace
}  // namespace tartan_calib::apps
