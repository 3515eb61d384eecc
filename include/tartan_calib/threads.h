#pragma once

#include <algorithm>
#include <functional>
#include <new>
#include <system_error>
#include <thread>
#include <vector>

namespace tartan_calib {

/// How many threads to run where a user asks for `wanted`; 0 stands for one per core. Far more than there are cores gain
/// nothing and cost memory, so there is a limit.
inline int numThreads(int wanted) {
  constexpr int kMaxThreadsPerCore = 4;
  static const int num_cores = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));  // asks the system
  return wanted > 0 ? std::min(wanted, kMaxThreadsPerCore * num_cores) : num_cores;
}

/// Starts up to `count` threads that run `work`: fewer, or none, where the system gives no more.
inline std::vector<std::thread> startThreads(int count, const std::function<void()>& work) {
  std::vector<std::thread> threads;
  threads.reserve(static_cast<std::size_t>(std::max(0, count)));
  try {
    while (static_cast<int>(threads.size()) < count) {
      threads.emplace_back(work);
    }
  } catch (const std::system_error&) {  // too many threads, or no room for a stack
  } catch (const std::bad_alloc&) {
  }
  return threads;
}

}  // namespace tartan_calib
