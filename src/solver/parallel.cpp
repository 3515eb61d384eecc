#include "tartan_calib/solver/parallel.h"

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

#include "tartan_calib/threads.h"

namespace tartan_calib::solver {
namespace {

Chunk chunkAt(int index, int num_items) {
  const auto border = [num_items](int i) { return static_cast<int>(std::int64_t{num_items} * i / kNumChunks); };
  return {index, border(index), border(index + 1)};
}

}  // namespace

void forEachChunk(int num_items, int num_threads, const std::function<void(const Chunk&)>& work) {
  const int num_workers = std::min({numThreads(num_threads), kNumChunks, std::max(1, num_items)});

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

  std::vector<std::thread> threads = startThreads(num_workers - 1, worker);
  worker();
  for (std::thread& thread : threads) {
    thread.join();
  }
  if (failure) {
    std::rethrow_exception(failure);
  }
}

void forEachItem(int num_items, int num_threads, const std::function<void(std::size_t)>& work) {
  forEachChunk(num_items, num_threads, [&work](const Chunk& chunk) {
    for (int i = chunk.begin; i < chunk.end; ++i) {
      work(static_cast<std::size_t>(i));
    }
  });
}

}  // namespace tartan_calib::solver
