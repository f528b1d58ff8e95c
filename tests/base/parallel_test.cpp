// SPDX-License-Identifier: Apache-2.0
#include "osteon/base/parallel.h"

#include <gtest/gtest.h>
#include <pthread.h>

#include <atomic>
#include <stdexcept>
#include <vector>

namespace osteon {
namespace {

struct Threads {  // sets the thread count for one test
  explicit Threads(int n) : before(threads()) { set_threads(n); }
  ~Threads() { set_threads(before); }
  int before;
};

TEST(Parallel, covers_every_item_once_in_ranges_that_do_not_depend_on_the_thread_count) {
  for (int n_threads : {1, 2, 4}) {
    const Threads scope(n_threads);
    std::vector<int> visits(1003, 0);
    parallel_for(visits.size(), 10, [&](std::size_t begin, std::size_t end) {
      EXPECT_EQ(begin % 10, 0u);
      EXPECT_EQ(end, std::min<std::size_t>(begin + 10, 1003));
      for (std::size_t i = begin; i < end; ++i) ++visits[i];
    });
    EXPECT_EQ(visits, std::vector<int>(1003, 1));
  }
}

TEST(Parallel, an_exception_of_the_body_reaches_the_caller) {
  const Threads scope(3);
  EXPECT_THROW(parallel_for(100, 1, [](std::size_t i, std::size_t) { if (i == 57) throw std::runtime_error("57"); }), std::runtime_error);
  std::atomic<int> count = 0;
  parallel_for(100, 1, [&](std::size_t, std::size_t) { ++count; });  // and the pool still works
  EXPECT_EQ(count, 100);
}

TEST(Parallel, makes_do_with_the_threads_that_the_system_gives) {
  pthread_attr_t before, vast;
  ASSERT_EQ(pthread_getattr_default_np(&before), 0);
  ASSERT_EQ(pthread_attr_init(&vast), 0);
  ASSERT_EQ(pthread_attr_setstacksize(&vast, std::size_t{1} << 50), 0);  // of which there is no memory for one
  const Threads scope(1);
  ASSERT_EQ(pthread_setattr_default_np(&vast), 0);
  set_threads(3);
  EXPECT_EQ(threads(), 1);
  ASSERT_EQ(pthread_setattr_default_np(&before), 0);
  std::atomic<int> count = 0;
  parallel_for(100, 1, [&](std::size_t, std::size_t) { ++count; });
  EXPECT_EQ(count, 100);
}

TEST(Parallel, nested_loops_finish) {
  const Threads scope(2);
  std::atomic<int> count = 0;
  parallel_for(8, 1, [&](std::size_t, std::size_t) { parallel_for(8, 1, [&](std::size_t, std::size_t) { ++count; }); });
  EXPECT_EQ(count, 64);
}

}  // namespace
}  // namespace osteon
