#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <string>
#include <utility>

namespace tartan_calib::apps {

/// Told by work of several items how many are done; first that none is.
using ProgressCall = std::function<void(std::size_t done, std::size_t total)>;

/// `45s`, `3m 05s`, `1h 02m`.
std::string durationText(double seconds);

/// Kalibr's progress line with the time left: redrawn in place on a terminal, else a line for every tenth of the work
/// while it lasts.
class ProgressBar {
 public:
  using Clock = std::chrono::steady_clock;

  explicit ProgressBar(bool is_terminal, std::function<Clock::time_point()> now = Clock::now)
      : is_terminal_(is_terminal), now_(std::move(now)) {}

  /// Begins anew where `done` is 0.
  void show(std::size_t done, std::size_t total);

  /// On a terminal, for work whose end is not known: what is done and for how long, once that is more than 2 seconds. Begins
  /// with show(0, 0).
  void showElapsed(const std::string& what);

  /// Takes the bar off the terminal.
  void clear();

 private:
  using Duration = std::chrono::duration<double>;

  bool isDue(std::size_t done, std::size_t total, Duration left) const;

  bool is_terminal_;
  std::function<Clock::time_point()> now_;
  bool is_drawn_ = false;
  Clock::time_point begin_;
  Clock::time_point drawn_at_;
  std::size_t drawn_done_ = 0;
};

}  // namespace tartan_calib::apps
