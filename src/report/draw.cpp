#include "tartan_calib/report/draw.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <fstream>
#include <iterator>
#include <thread>

#include "listen.h"
#include "tartan_calib/error.h"
#include "tartan_calib/io/atomic_file.h"

namespace tartan_calib::report {
namespace {

constexpr auto kPoll = std::chrono::milliseconds(20);

/// The distribution's Python has matplotlib when its package is installed; one that stands first on PATH may not.
const char* python() {
  constexpr const char* kSystemPython = "/usr/bin/python3";
  return access(kSystemPython, X_OK) == 0 ? kSystemPython : "python3";
}

std::string contents(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

std::string lastLine(const std::string& path) {
  std::ifstream file(path);
  std::string last = "no message";
  for (std::string line; std::getline(file, line);) {
    last = line.empty() ? last : line;
  }
  return last;
}

/// Starts the program with its output in a file; throws InputError where it cannot be started.
pid_t start(const std::array<const char*, 5>& words, const std::string& log) {
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, log.c_str(), O_WRONLY | O_CREAT | O_TRUNC, S_IRUSR | S_IWUSR);
  posix_spawn_file_actions_adddup2(&actions, STDOUT_FILENO, STDERR_FILENO);
  posix_spawnattr_t attributes;  // a process group of its own, so that all of it can be ended
  posix_spawnattr_init(&attributes);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
  std::array<char*, 5> arguments{};
  for (std::size_t i = 0; i < words.size(); ++i) {
    arguments[i] = const_cast<char*>(words[i]);  // the interface of exec, which changes nothing
  }
  pid_t process = 0;
  const int error = posix_spawnp(&process, words[0], &actions, &attributes, arguments.data(), environ);
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&actions);
  if (error != 0) {
    throw InputError(std::string("cannot run ") + words[0] + " (" + std::strerror(error) +
                     "): install python3 and python3-matplotlib");
  }
  return process;
}

void tellDrawn(const std::string& path, const Listener& listener) {
  std::ifstream file(path);
  std::size_t total = 0;
  std::string dots;
  file >> total >> dots;
  listener.progress(dots.size(), total);
}

/// Exit status as waitpid has it.
int wait(pid_t process, const std::string& drawn, const Listener& listener) {
  int status = 0;
  while (waitpid(process, &status, WNOHANG) == 0) {
    if (isCancelled(listener)) {
      kill(-process, SIGKILL);
    } else if (listener.progress) {
      tellDrawn(drawn, listener);
    }
    std::this_thread::sleep_for(kPoll);
  }
  return status;
}

}  // namespace

void drawReport(const std::string& script, const std::string& folder, const std::string& pdf_path,
                const std::string& html_path, const Listener& listener) {
  const std::string log = folder + "/log.txt";
  const pid_t process = start({python(), "-B", script.c_str(), folder.c_str(), nullptr}, log);
  const int status = wait(process, folder + "/drawn", listener);
  throwIfCancelled(listener);
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) {
    throw InputError(lastLine(log));
  }
  io::AtomicFileSet together;
  together.add(pdf_path).write(contents(folder + "/report.pdf"));
  together.add(html_path).write(contents(folder + "/report.html"));
  together.commit();
}

}  // namespace tartan_calib::report
