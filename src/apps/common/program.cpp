#include "common/program.h"

#include <algorithm>
#include <chrono>
#include <cinttypes>
#include <csignal>
#include <cstdio>
#include <exception>
#include <new>
#include <regex>

namespace tartan_calib::apps {
namespace {

void printLine(std::FILE* file, const char* level, std::string message) {
  constexpr std::int64_t kUsPerSecond = 1'000'000;
  std::replace(message.begin(), message.end(), '\n', ' ');
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  const std::int64_t now_us = std::chrono::duration_cast<std::chrono::microseconds>(now).count();
  std::fflush(stdout);  // so that lines keep their order where both go to one place
  std::fprintf(file, "[%s] [%" PRId64 ".%06" PRId64 "]: %s\n", level, now_us / kUsPerSecond, now_us % kUsPerSecond,
               message.c_str());
  std::fflush(file);
}

}  // namespace

int runProgram(const std::function<int()>& body) {
  std::signal(SIGXFSZ, SIG_IGN);  // a file above the limit of `ulimit -f` then fails as one on a full disk does
  try {
    return body();
  } catch (const UsageError& error) {
    printError(error.what());
    return kWrongUsage;
  } catch (const Error& error) {
    printError(error.what());
  } catch (const std::bad_alloc&) {
    printError("out of memory: use fewer images (--bag-freq, --bag-from-to) or fewer threads (--threads)");
  } catch (const std::exception& error) {
    printError(std::string("unexpected failure: ") + error.what());
  }
  return kFailure;
}

int runProgram(int argc, char** argv, const std::function<int(const std::vector<std::string>& words)>& body) {
  return runProgram([&] { return body(commandWords(argc, argv)); });
}

std::vector<std::string> commandWords(int argc, const char* const* argv) {
  const std::regex remapping("^[A-Za-z_~/][A-Za-z0-9_/]*:=");
  std::vector<std::string> words(argv + 1, argv + argc);
  const auto is_remapping = [&remapping](const std::string& word) { return std::regex_search(word, remapping); };
  words.erase(std::remove_if(words.begin(), words.end(), is_remapping), words.end());
  return words;
}

void printInfo(const std::string& message) { printLine(stdout, " INFO", message); }

void printWarning(const std::string& message) { printLine(stdout, " WARN", message); }

void printError(const std::string& message) { printLine(stderr, "ERROR", message); }

}  // namespace tartan_calib::apps
