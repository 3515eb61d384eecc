#include "../../src/pipeline/ordered_workers.h"

#include <gtest/gtest.h>
#include <pthread.h>

#include "tartan_calib/threads.h"

namespace tartan_calib::pipeline {
namespace {

/// While it lives, threads ask for stacks of that size.
class StackSize {
 public:
  explicit StackSize(std::size_t bytes) {
    pthread_getattr_default_np(&before_);
    pthread_attr_t attributes;
    pthread_getattr_default_np(&attributes);
    pthread_attr_setstacksize(&attributes, bytes);
    pthread_setattr_default_np(&attributes);
    pthread_attr_destroy(&attributes);
  }
  ~StackSize() {
    pthread_setattr_default_np(&before_);
    pthread_attr_destroy(&before_);
  }
  StackSize(const StackSize&) = delete;
  StackSize& operator=(const StackSize&) = delete;

 private:
  pthread_attr_t before_{};
};

constexpr std::size_t kWholeAddressSpace = std::size_t{1} << 47U;  ///< of a process on x86-64: there is no room for one
constexpr std::size_t kTenthOfIt = kWholeAddressSpace / 10;        ///< room for some, not for all that are asked for

std::vector<int> squares(int num_threads) {
  OrderedWorkers<int> workers(num_threads);
  for (int i = 0; i < 20; ++i) {
    workers.submit([i] { return i * i; });
  }
  std::vector<int> results;
  while (workers.numPending() > 0) {
    results.push_back(workers.next());
  }
  return results;
}

TEST(OrderedWorkers, GiveResultsInOrderWithAsManyThreadsAsThereAre) {
  const std::vector<int> expected = squares(1);
  ASSERT_EQ(expected.size(), 20U);
  EXPECT_EQ(expected[7], 49);
  EXPECT_EQ(squares(5), expected);
  {
    const StackSize few(kTenthOfIt);
    EXPECT_EQ(squares(30), expected);
  }
  const StackSize none(kWholeAddressSpace);
  EXPECT_EQ(squares(5), expected);
}

TEST(OrderedWorkers, WithoutAThreadTheyThrowWhatATaskThrew) {
  const StackSize none(kWholeAddressSpace);
  OrderedWorkers<int> workers(2);
  workers.submit([]() -> int { throw std::runtime_error("task"); });
  workers.submit([] { return 2; });
  EXPECT_THROW(workers.next(), std::runtime_error);
  EXPECT_EQ(workers.next(), 2);
}

TEST(NumThreads, IsWhatWasAskedForUpToAFewPerCore) {
  EXPECT_EQ(numThreads(1), 1);
  EXPECT_GE(numThreads(0), 1);
  EXPECT_EQ(numThreads(1'000'000), 4 * numThreads(0));
}

}  // namespace
}  // namespace tartan_calib::pipeline
