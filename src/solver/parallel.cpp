#include "parallel.h"

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace tartan_calib::solver {
namespace {

Chunk chunkAt(int index, int num_items) {
  const auto border = [num_items](int i) { return static_cast<int>(std::int64_t{num_items} * i / kNumChunks); };
  return {index, border(index), border(index + 1)};
}

}  // namespace

void forEachChunk(int num_items, int num_threads, const std::function<void(const Chunk&)>& work) {
  const int num_cores = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  const int num_workers = std::min({num_threads > 0 ? num_threads : num_cores, kNumChunks, std::max(1, num_items)});

  std::atomic<int> next_chunk{0};
  std::exception_ptr failure;
  std::mutex failure_mutex;
  const auto worker = [&] {
    for (int index = next_chunk++; index < kNumChunks; index = next_chunk++) {
      const Chunk chunk = chunkAt(index, num_items);
      try {
        work(chunk);
      } catch (...) {
        const std::lock_guard<std::mutex> lock(failure_mutex);
        failure = std::current_exception();
      }
    }
  };

  std::vector<std::thread> threads;
  for (int i = 1; i < num_workers; ++i) {
    threads.emplace_back(worker);
  }
  worker();
  for (std::thread& thread : threads) {
    thread.join();
  }
  if (failure) {
    std::rethrow_exception(failure);
  }
}

}  // namespace tartan_calib::solver
