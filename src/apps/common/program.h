#pragma once

#include <functional>
#include <string>
#include <vector>

#include "tartan_calib/error.h"

namespace tartan_calib::apps {

/// Exit codes of every program: 0 only with a result.
enum ExitCode : int {
  kSuccess = 0,
  kFailure = 1,
  kWrongUsage = 2,
  kInterrupted = 130,  ///< 128 + SIGINT, as shells have it
};

/// The command line cannot be understood.
class UsageError : public Error {
 public:
  using Error::Error;
};

/// Runs the body of a program. What it throws becomes one line on standard error that starts with `[ERROR]`, and the exit
/// code that belongs to it.
int runProgram(const std::function<int()>& body);

/// The same for a body that takes the words after the program's name.
int runProgram(int argc, char** argv, const std::function<int(const std::vector<std::string>& words)>& body);

/// The words after the program's name, without names that ROS is to remap, such as `__name:=x`, `_parameter:=x` and
/// `topic:=x`: roslaunch adds some to any command line.
std::vector<std::string> commandWords(int argc, const char* const* argv);

/// Lines in the manner of Kalibr's logger, `[ WARN] [<seconds since 1970>]: message`, on standard output. A message of
/// several lines becomes one.
void printInfo(const std::string& message);
void printWarning(const std::string& message);

/// The same with `[ERROR]`, on standard error.
void printError(const std::string& message);

}  // namespace tartan_calib::apps
