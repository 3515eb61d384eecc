#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <functional>
#include <future>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

#include "tartan_calib/threads.h"

namespace tartan_calib::pipeline {

/// Runs tasks on threads and hands their results back in the order in which the tasks were submitted, so that the number of
/// threads shows in nothing but time. Used from one thread.
template <typename Result>
class OrderedWorkers {
 public:
  explicit OrderedWorkers(int num_threads) {
    threads_ = startThreads(num_threads, [this] { work(); });
  }

  /// Drops tasks that have not begun and waits for the others.
  ~OrderedWorkers() {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      tasks_.clear();
      is_closed_ = true;
    }
    task_ready_.notify_all();
    for (std::thread& thread : threads_) {
      thread.join();
    }
  }

  OrderedWorkers(const OrderedWorkers&) = delete;
  OrderedWorkers& operator=(const OrderedWorkers&) = delete;

  void submit(std::function<Result()> task) {
    std::packaged_task<Result()> packaged(std::move(task));
    results_.push_back(packaged.get_future());
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      tasks_.push_back(std::move(packaged));
    }
    task_ready_.notify_one();
  }

  /// Tasks whose results have not been taken.
  std::size_t numPending() const { return results_.size(); }

  /// Waits for the oldest task, or does it where no thread could be started; throws what it threw.
  Result next() {
    if (threads_.empty()) {
      tasks_.front()();
      tasks_.pop_front();
    }
    std::future<Result> result = std::move(results_.front());
    results_.pop_front();
    return result.get();
  }

 private:
  void work() {
    while (true) {
      std::unique_lock<std::mutex> lock(mutex_);
      task_ready_.wait(lock, [this] { return is_closed_ || !tasks_.empty(); });
      if (tasks_.empty()) {
        return;
      }
      std::packaged_task<Result()> task = std::move(tasks_.front());
      tasks_.pop_front();
      lock.unlock();
      task();
    }
  }

  std::mutex mutex_;
  std::condition_variable task_ready_;
  std::deque<std::packaged_task<Result()>> tasks_;
  bool is_closed_ = false;
  std::deque<std::future<Result>> results_;
  std::vector<std::thread> threads_;
};

}  // namespace tartan_calib::pipeline
