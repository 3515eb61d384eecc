#include "common/interrupt.h"

#include <unistd.h>

#include <csignal>

namespace tartan_calib::apps {
namespace {

volatile std::sig_atomic_t is_in_section = 0;
volatile std::sig_atomic_t waiting_signal = 0;

/// Only what a signal handler may call.
[[noreturn]] void leave(int signal) {
  constexpr char kMessage[] = "\n[ WARN]: Shutdown requested! (CTRL+C)\n";
  constexpr int kSignalExitBase = 128;
  if (write(STDERR_FILENO, kMessage, sizeof(kMessage) - 1) < 0) {
    _exit(kSignalExitBase + signal);
  }
  _exit(kSignalExitBase + signal);
}

extern "C" void handleSignal(int signal) {
  if (is_in_section != 0) {
    waiting_signal = signal;
    return;
  }
  leave(signal);
}

}  // namespace

void installInterruptHandler() {
  std::signal(SIGINT, handleSignal);
  std::signal(SIGTERM, handleSignal);
}

UninterruptedSection::UninterruptedSection() { is_in_section = 1; }

UninterruptedSection::~UninterruptedSection() {
  is_in_section = 0;
  if (waiting_signal != 0) {
    leave(waiting_signal);
  }
}

bool isInterruptWaiting() { return waiting_signal != 0; }

}  // namespace tartan_calib::apps
