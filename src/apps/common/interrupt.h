#pragma once

namespace tartan_calib::apps {

/// Ctrl-C (and SIGTERM) end the program at once with Kalibr's message and exit code 128 + signal, except during an
/// UninterruptedSection.
void installInterruptHandler();

/// While one exists signals wait: files are finished first.
class UninterruptedSection {
 public:
  UninterruptedSection();
  ~UninterruptedSection();
  UninterruptedSection(const UninterruptedSection&) = delete;
  UninterruptedSection& operator=(const UninterruptedSection&) = delete;
};

/// True once a signal waits for the end of the section: work that need not be finished may stop.
bool isInterruptWaiting();

}  // namespace tartan_calib::apps
