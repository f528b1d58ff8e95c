// SPDX-License-Identifier: Apache-2.0
#include "osteon/train/batches_ahead.h"

#include "osteon/base/parallel.h"
#include "support/expect.h"

namespace osteon::train {
namespace {

// A batch that says which one it is.
dataset::Batch numbered(std::uint64_t step) {
  dataset::Batch batch;
  batch.targets.root = {static_cast<std::int32_t>(step)};
  return batch;
}

class BatchesAheadWith : public ::testing::TestWithParam<int> {
 protected:
  BatchesAheadWith() : before_(threads()) { set_threads(GetParam()); }
  ~BatchesAheadWith() override { set_threads(before_); }

 private:
  int before_;
};

TEST_P(BatchesAheadWith, come_in_the_order_of_their_steps) {
  BatchesAhead batches(numbered, 5);
  for (std::int32_t step = 5; step < 25; ++step) EXPECT_EQ(batches.next().targets.root.front(), step);
}

TEST_P(BatchesAheadWith, throw_what_making_them_threw) {
  BatchesAhead batches([](std::uint64_t) -> dataset::Batch { throw Error("a bad character"); }, 0);
  EXPECT_EQ(test::error_of([&] { batches.next(); }), "a bad character");
}

INSTANTIATE_TEST_SUITE_P(Threads, BatchesAheadWith, ::testing::Values(1, 2, 3));

}  // namespace
}  // namespace osteon::train
