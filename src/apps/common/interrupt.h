#pragma once

#include <string>

#include "tartan_calib/error.h"

namespace tartan_calib::apps {

/// Ctrl-C (and SIGTERM) end the program at once with Kalibr's message, a line about what is finished, and exit code
/// 128 + signal, except during an UninterruptedSection. To be called on the main thread, which gets the signals.
void installInterruptHandler();

/// The line about what is finished: `stopped <step>; <finished>`, such as `stopped in round 1 (recover cam0); nothing was
/// written`. Main thread only.
void setInterruptedStep(const std::string& step);
void setFinishedWork(const std::string& finished);

/// While one exists signals wait: files are finished first. Main thread only; one may be within another.
class UninterruptedSection {
 public:
  UninterruptedSection();
  ~UninterruptedSection();
  UninterruptedSection(const UninterruptedSection&) = delete;
  UninterruptedSection& operator=(const UninterruptedSection&) = delete;
};

/// True once a signal waits for the end of the section: work that need not be finished may stop.
bool isInterruptWaiting();

/// Unwinds to the end of the section, where the program ends.
class Interrupted : public Error {
 public:
  Interrupted() : Error("interrupted") {}
};

/// The step `after <done> of <total> <items>`, for work of which the part that is done is worth nothing alone.
void setItemsDone(std::size_t done, std::size_t total, const std::string& items);

/// Throws Interrupted where a signal waits.
void throwIfInterrupted();

}  // namespace tartan_calib::apps
