#include "common/progress_bar.h"

#include <cmath>
#include <cstdio>

namespace tartan_calib::apps {
namespace {

constexpr std::chrono::milliseconds kRedrawInterval{100};
constexpr std::chrono::seconds kLineInterval{2};  ///< a log needs no more
constexpr std::size_t kLinesPerRun = 10;
constexpr std::chrono::seconds kLongStep{2};  ///< shorter ones need no word

constexpr const char* kClearLine = "\r\x1b[K";

std::string twoDigits(long value) { return (value < 10 ? "0" : "") + std::to_string(value); }

}  // namespace

std::string durationText(double seconds) {
  constexpr long kSecondsPerMinute = 60;
  constexpr long kSecondsPerHour = 3600;
  const long whole = std::lround(seconds);
  if (whole < kSecondsPerMinute) {
    return std::to_string(whole) + "s";
  }
  if (whole < kSecondsPerHour) {
    return std::to_string(whole / kSecondsPerMinute) + "m " + twoDigits(whole % kSecondsPerMinute) + "s";
  }
  return std::to_string(whole / kSecondsPerHour) + "h " + twoDigits(whole % kSecondsPerHour / kSecondsPerMinute) + "m";
}

bool ProgressBar::isDue(std::size_t done, std::size_t total, Duration left) const {
  const Clock::duration since = now_() - drawn_at_;
  if (is_terminal_) {
    return since >= kRedrawInterval;
  }
  const bool is_tenth = done > drawn_done_ && (done - drawn_done_) * kLinesPerRun >= total;
  return is_tenth && since >= kLineInterval && left >= kLineInterval;
}

void ProgressBar::show(std::size_t done, std::size_t total) {
  if (done == 0) {
    begin_ = drawn_at_ = now_();
    drawn_done_ = 0;
    return;
  }
  const Duration taken = now_() - begin_;
  const Duration left = taken / static_cast<double>(done) * static_cast<double>(total - done);
  if (!isDue(done, total, left)) {
    return;
  }
  std::printf("%s  Progress %zu / %zu \t Time remaining: %s%s", is_terminal_ ? kClearLine : "", done, total,
              durationText(left.count()).c_str(), is_terminal_ ? "" : "\n");
  std::fflush(stdout);
  is_drawn_ = is_terminal_;
  drawn_at_ = now_();
  drawn_done_ = done;
}

void ProgressBar::showElapsed(const std::string& what) {
  constexpr std::chrono::seconds kStep{1};
  const Clock::time_point now = now_();
  if (!is_terminal_ || now - begin_ < kLongStep || (is_drawn_ && now - drawn_at_ < kStep)) {
    return;
  }
  const Duration taken = now - begin_;
  std::printf("%s  %s: %s", kClearLine, what.c_str(), durationText(taken.count()).c_str());
  std::fflush(stdout);
  is_drawn_ = true;
  drawn_at_ = now;
}

void ProgressBar::clear() {
  if (is_drawn_) {
    std::fputs(kClearLine, stdout);
    is_drawn_ = false;
  }
}

}  // namespace tartan_calib::apps
