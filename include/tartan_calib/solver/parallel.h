#pragma once

#include <cstddef>
#include <functional>

namespace tartan_calib::solver {

/// Sums over blocks are formed chunk by chunk, then over chunks in order, so that rounding does not depend on the number of
/// threads. Few enough chunks for one accumulator each, enough for all cores of a usual machine.
constexpr int kNumChunks = 32;

struct Chunk {
  int index = 0;
  int begin = 0;
  int end = 0;
};

/// Calls `work` once per chunk of [0, num_items), from up to num_threads threads (0: all cores). Rethrows what it throws.
void forEachChunk(int num_items, int num_threads, const std::function<void(const Chunk&)>& work);

/// The same, once per item, for work whose results are kept by item.
void forEachItem(int num_items, int num_threads, const std::function<void(std::size_t)>& work);

}  // namespace tartan_calib::solver
