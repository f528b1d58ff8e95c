// SPDX-License-Identifier: Apache-2.0
#include "osteon/base/parallel.h"

#include <algorithm>
#include <atomic>
#include <cassert>
#include <condition_variable>
#include <exception>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

namespace osteon {
namespace {

thread_local bool inside_parallel_for = false;

// One loop in flight: ranges are handed out in order; the caller waits until none is running.
struct Loop {
  std::size_t n, grain;
  const std::function<void(std::size_t, std::size_t)>* body;
  std::atomic<std::size_t> next{0};
  std::exception_ptr error;
  std::mutex error_mutex;

  void run() {
    inside_parallel_for = true;
    for (std::size_t begin = next.fetch_add(grain); begin < n; begin = next.fetch_add(grain)) {
      try {
        (*body)(begin, std::min(n, begin + grain));
      } catch (...) {
        const std::lock_guard lock(error_mutex);
        if (!error) error = std::current_exception();
        next = n;
      }
    }
    inside_parallel_for = false;
  }
};

class Pool {
 public:
  // As many as the system gives: results do not depend on their number.
  explicit Pool(int helpers) {
    threads_.reserve(static_cast<std::size_t>(helpers));
    try {
      for (int i = 0; i < helpers; ++i) threads_.emplace_back([this] { serve(); });
    } catch (const std::exception&) {  // out of threads, or of memory for one
    }
  }
  ~Pool() {
    {
      const std::lock_guard lock(mutex_);
      stop_ = true;
    }
    wake_.notify_all();
    for (std::thread& t : threads_) t.join();
  }
  int size() const { return static_cast<int>(threads_.size()) + 1; }

  void run(Loop& loop) {
    const std::lock_guard one_loop_at_a_time(run_mutex_);
    {
      const std::lock_guard lock(mutex_);
      loop_ = &loop;
      ++generation_;
    }
    wake_.notify_all();
    loop.run();
    {
      const std::lock_guard lock(mutex_);
      loop_ = nullptr;  // a helper that wakes late finds nothing to do
    }
    const auto is_done = [this] { return busy_ == 0; };
    if (soon(is_done)) return;
    std::unique_lock lock(mutex_);
    done_.wait(lock, is_done);
  }

 private:
  // Whether it holds within some ten microseconds. A thread that sleeps takes longer than that to wake, and one loop often follows another.
  template <class Condition>
  static bool soon(const Condition& holds) {
    for (int i = 0; i < kLooks; ++i) {
      if (holds()) return true;
      std::this_thread::yield();
    }
    return false;
  }

  void serve() {
    std::size_t seen = 0;
    while (true) {
      soon([&] { return generation_ != seen; });
      std::unique_lock lock(mutex_);
      if (generation_ != seen && !loop_ && !stop_) {  // come and gone
        seen = generation_;
        continue;
      }
      wake_.wait(lock, [&] { return stop_ || (loop_ && generation_ != seen); });
      if (stop_) return;
      seen = generation_;
      Loop* loop = loop_;
      ++busy_;
      lock.unlock();
      loop->run();
      lock.lock();
      if (--busy_ == 0) done_.notify_all();
    }
  }

  static constexpr int kLooks = 100;  // 26 ms of the mean shift's many short loops become 24 with 20, 20 with 50 and 19 with 100
  std::vector<std::thread> threads_;
  std::mutex run_mutex_, mutex_;
  std::condition_variable wake_, done_;
  Loop* loop_ = nullptr;
  std::atomic<std::size_t> generation_{0};
  std::atomic<int> busy_{0};
  bool stop_ = false;
};

int default_threads() { return std::max(1u, std::thread::hardware_concurrency()); }

std::unique_ptr<Pool>& pool() {
  static std::unique_ptr<Pool> instance = std::make_unique<Pool>(default_threads() - 1);
  return instance;
}

}  // namespace

int threads() { return pool()->size(); }

void set_threads(int n) {
  assert(n >= 1);
  if (n != threads()) pool() = std::make_unique<Pool>(n - 1);
}

void parallel_for(std::size_t n, std::size_t grain, const std::function<void(std::size_t, std::size_t)>& body) {
  assert(grain > 0);
  if (n == 0) return;
  if (inside_parallel_for || n <= grain || threads() == 1) {
    for (std::size_t begin = 0; begin < n; begin += grain) body(begin, std::min(n, begin + grain));
    return;
  }
  Loop loop;
  loop.n = n;
  loop.grain = grain;
  loop.body = &body;
  pool()->run(loop);
  if (loop.error) std::rethrow_exception(loop.error);
}

}  // namespace osteon
