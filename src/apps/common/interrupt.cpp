#include "common/interrupt.h"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <csignal>

namespace tartan_calib::apps {
namespace {

/// What a signal makes the program print. A handler may not touch a string.
struct LastWords {
  static constexpr std::size_t kMaxLength = 2000;
  std::array<char, kMaxLength> text{};
  std::size_t length = 0;
};

volatile std::sig_atomic_t num_sections = 0;
volatile std::sig_atomic_t waiting_signal = 0;

std::string interrupted_step;
std::string finished_work = "nothing was written";
LastWords last_words;

/// Only what a signal handler may call.
[[noreturn]] void leave(int signal) {
  constexpr int kSignalExitBase = 128;
  [[maybe_unused]] const ssize_t num_written = write(STDERR_FILENO, last_words.text.data(), last_words.length);
  _exit(kSignalExitBase + signal);
}

extern "C" void handleSignal(int signal) {
  if (num_sections > 0) {
    waiting_signal = signal;
    return;
  }
  leave(signal);
}

void composeLastWords() {
  const UninterruptedSection words_are_whole;
  const std::string text = "\n[ WARN]: Shutdown requested! (CTRL+C)\n[ WARN]: stopped" +
                           (interrupted_step.empty() ? "" : " " + interrupted_step) + "; " + finished_work + "\n";
  last_words.length = std::min(text.size(), LastWords::kMaxLength);
  std::copy_n(text.begin(), last_words.length, last_words.text.begin());
}

}  // namespace

void installInterruptHandler() {
  composeLastWords();
  std::signal(SIGINT, handleSignal);
  std::signal(SIGTERM, handleSignal);
}

void setInterruptedStep(const std::string& step) {
  interrupted_step = step;
  composeLastWords();
}

void setFinishedWork(const std::string& finished) {
  finished_work = finished;
  composeLastWords();
}

UninterruptedSection::UninterruptedSection() { num_sections = num_sections + 1; }

UninterruptedSection::~UninterruptedSection() {
  num_sections = num_sections - 1;
  if (num_sections == 0 && waiting_signal != 0) {
    leave(waiting_signal);
  }
}

bool isInterruptWaiting() { return waiting_signal != 0; }

void setItemsDone(std::size_t done, std::size_t total, const std::string& items) {
  setInterruptedStep("after " + std::to_string(done) + " of " + std::to_string(total) + " " + items);
}

void throwIfInterrupted() {
  if (isInterruptWaiting()) {
    throw Interrupted();
  }
}

}  // namespace tartan_calib::apps
